// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Stamps of arrival: poses that were buffered come several at once, then none for a while. A sensor that does
// measure so moves little within a burst; one whose poses waited moves as far between any two of them.
#pragma once

#include <cstddef>
#include <vector>

#include "egocal/diagnosis/verdict.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct BurstOptions {
  std::size_t most = 4000;  ///< poses that are looked at, from the middle
  std::size_t least = 60;   ///< and at least
  /// Poses on both sides that show how long a step usually takes here: keyframes of a vehicle that slows down
  /// come less often, in no bursts.
  std::size_t reach_of_time = 24;
  /// Steps that take less than this part of the usual time are within a burst; at least this part of all
  /// steps are. Two poses at once make half.
  double within = 0.25, part = 0.4;
  /// Steps of a burst, at most. Less than reach_of_time: beside a pause of the recording as many steps as
  /// that are shorter than the mean.
  std::size_t longest = 20;
  std::size_t reach = 8;  ///< poses on both sides that show which way a step leads
  /// Mean way along there of the steps within bursts over that of the others, at least and, inverted, at
  /// most: 1 where the poses waited, at most 0.25 where they were measured so, and large where the vehicle
  /// stood between the bursts. Noise goes any way.
  double alike = 0.6;
  /// Where the motions agree to this part of their length the stamps are right, whatever they look like.
  double agreement = 0.005;
};

/// Mean way of the steps within bursts over that of the others; 0 where the stamps come in no bursts.
double motion_in_bursts(const Trajectory& poses, const BurstOptions& options = {});

/// stamps_a and stamps_b, certain; none where the fit is that of right stamps.
std::vector<Finding> stamps_in_bursts(const Trajectory& a, const Trajectory& b, const Fit& fit,
                                      const BurstOptions& options = {});

}  // namespace egocal::detail
