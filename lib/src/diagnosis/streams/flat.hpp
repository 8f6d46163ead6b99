// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Streams in two dimensions: a coordinate of the positions, or roll and pitch, never change although the
// sensor, or the other one, tilts.
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct FlatOptions {
  std::size_t most = 4000;     ///< poses that are looked at; bounds the cost of a drive of any length
  std::size_t least = 20;      ///< poses and motions; fewer may be level by chance
  double flat = 1e-6;          ///< of the longest extent: a coordinate that changes by less never changes
  double least_tilt = 0.0175;  ///< of a stream with a flat coordinate: a degree [rad]; level ground is within
  /// A stream with a flat coordinate that turns out of that plane by less was given in two dimensions [rad].
  double level = 1e-5;
  /// The other one tilts where it does by more than least_tilt in this part of the drive, and by more than so
  /// many times what both streams differ by in turning in the plane: noise of rotations has no plane.
  std::size_t parts = 32;
  double over_noise = 3;
};

/// flat_a or flat_b, certain. own: the stream of this side, as it was read.
std::optional<Finding> flat(const Trajectory& own, Side side, const Instants& instants,
                            const FlatOptions& options = {});

}  // namespace egocal::detail
