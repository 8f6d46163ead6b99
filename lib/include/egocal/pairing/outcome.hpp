// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "egocal/problem/cost.hpp"

namespace egocal {

/// Why a pose or a motion is not in the statistics.
enum class Rejection {
  not_finite,        ///< NaN, infinity, a quaternion far from unit length, or beyond egocal::limits
  out_of_order,      ///< known, or so late that poses after it have been paired
  no_partner,        ///< the other stream has no pose on one side of it (before its start, after its end)
  gap,               ///< the neighbours in the other stream, or the two ends of the motion, are too far apart
  frozen,            ///< one sensor repeats its pose to the last digit while the other one moves
  screw_congruence,  ///< the motions to and from a pose differ in angle or slide by more than noise explains
  too_much_rotation,  ///< so near to half a turn that the sign of its quaternion is a guess
  count_
};
std::string_view to_string(Rejection reason);

/// Number of rejections by reason.
struct Rejections {
  std::array<std::uint64_t, static_cast<std::size_t>(Rejection::count_)> by_reason{};

  void add(Rejection reason, std::uint64_t count = 1) {
    by_reason[static_cast<std::size_t>(reason)] += count;
  }
};

/// What became of the poses.
struct PairingCounts {
  std::uint64_t poses_a = 0, poses_b = 0;  ///< handed in
  std::uint64_t synchronised = 0;          ///< instants for which both poses are known
  std::uint64_t matched = 0;               ///< motion pairs in the statistics (of the chosen stride)
  std::uint64_t outliers =
      0;  ///< motion pairs (of the chosen stride) that contradict the others; may come back
  /// Steps across which an odometry jumps, as a sum over strides finds them (Choice): no motion spans them.
  std::uint64_t jumps = 0;
  std::array<std::uint64_t, static_cast<std::size_t>(Rejection::count_)> rejected{};
};

/// The setting that is in force and why.
struct Choice {
  int stride = 1;   ///< the best single one
  Balance balance;  ///< of that stride
  /// Mean length of the motions [steps] where the problem is a sum of motions of many strides, each weighted
  /// by its residuals; 0: the motions of `stride` alone.
  double mean_stride = 0;
  std::string reason;  ///< "fixed", or the jack-knife's numbers in a short sentence
};

}  // namespace egocal
