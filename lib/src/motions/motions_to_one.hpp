// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/motions/instant.hpp"
#include "problem/motion_square.hpp"

namespace egocal::detail {

/// Motions of both sensors from some instants to one.
struct MotionsToOne {
  static constexpr int count = 4;  ///< as many as the widest vectors hold

  std::array<MotionSquare, count> squares;
  std::array<double, count> least_scalar{};  ///< the smaller one of both motions' real scalars
  /// False for a half turn, or for poses that are no rotations: the rest is then unset, and motions_between()
  /// and MotionSquare say what they are. They are rare.
  std::array<bool, count> plain{};
  /// Differences of both motions' quaternions, of the real and then of the dual ones: s, u and w of
  /// QuaternionDifference.
  std::array<std::array<double, count>, 14> differences;
};

/// The same bits as motions_between() and MotionSquare, at half the cost: an instant ends the motions of
/// fourteen strides. in_pairs: as on processors without wide vectors, for tests.
void set_motions_to_one(const std::array<const Instant*, MotionsToOne::count>& from, const Instant& to,
                        MotionsToOne& result, bool in_pairs = false);

}  // namespace egocal::detail
