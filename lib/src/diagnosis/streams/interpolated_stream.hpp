// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A stream that was interpolated before it was given: poses on straight lines, or along screws, between fewer
// poses; or its positions alone, or its rotations alone.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "egocal/diagnosis/verdict.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct InterpolatedStreamOptions {
  std::size_t most = 4000;  ///< poses that are looked at, from the middle: bounds the cost of a long drive
  std::size_t least = 60;   ///< poses of a shorter stream may be on straight lines by chance
  /// A pose lies between its neighbours where the velocities before and after it differ by less than this
  /// part, or by the digits of a file [m, rad]. Steps of sensors differ by a percent, by noise alone.
  double straight = 1e-3, digits = 3e-6;
  /// Half of the others differ from their neighbours by more than this many times as much: the ends of lines.
  /// A sensor that turns evenly, in noise of 0.1 %, is bent by a few times as much everywhere.
  double corner = 10;
  double rounding = 1e-12;  ///< of positions far from the origin, as a part of them
  /// Part of the poses that do, at least, in this stream, and at most in the other one: straight lines of
  /// machines, or of noiseless simulations, are in both.
  double part = 0.4, other_part = 0.1;
};

/// How far the step after a pose differs from the one before, in units of what a straight one may.
struct Bend {
  double bent = 0;
  bool rests = false;  ///< it hardly moves, or turns
};
struct Bends {
  Bend pose, position, rotation;
  double seconds = 0;  ///< since the pose before
};

/// Bends at pose i, which is neither the first nor the last one. Empty where stamps repeat.
std::optional<Bends> bends_at(const Trajectory& poses, std::size_t i,
                              const InterpolatedStreamOptions& options = {});

/// undersampled_a or undersampled_b, certain: of which stream, and its real rate.
std::vector<Finding> interpolated_streams(const Trajectory& a, const Trajectory& b,
                                          const InterpolatedStreamOptions& options = {});

}  // namespace egocal::detail
