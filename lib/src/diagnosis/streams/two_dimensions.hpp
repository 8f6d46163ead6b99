// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Both streams in two dimensions, as wheel odometry beside a SLAM of flat scans: what the ground is, both
// files assume. The motions then agree about roll and pitch without an error, as neither measured them.
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "diagnosis/streams/assumed.hpp"

namespace egocal::detail {

struct TwoDimensionsOptions {
  std::size_t least = 20;  ///< motions; fewer may be about one axis by chance
  /// A stream that turns about one axis, and about others by less [rad]: digits of a file leave 1e-6, and no
  /// sensor that measures three angles has so little noise.
  double level = 1e-5;
  double least_turn = 0.0175;  ///< of the motions, root mean square [rad]; less is no axis
  /// The headings differ by more than so many times of `level`: where nothing differs the streams are without
  /// noise, and three angles may be as exact as one.
  double over_level = 3;
  /// Angles about directions of a in which the axis has a part of at most this are assumed (20 degrees from
  /// it).
  double across = 0.94;
};

/// flat_both: both streams turn about one axis alone. Empty where one of them turns about further axes.
/// Deterministic; thread-safe.
std::optional<Assumed> two_dimensions(const Motions& motions, const TwoDimensionsOptions& options = {});

}  // namespace egocal::detail
