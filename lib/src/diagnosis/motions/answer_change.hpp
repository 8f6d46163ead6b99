// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How an answer changes where the same motions are taken from the streams in another way.
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/options.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

/// Directions: x y z roll pitch yaw in sensor a's frame [m, rad].
struct AnswerChange {
  Vector6d size = Vector6d::Zero();
  Vector6d variance = Vector6d::Zero();  ///< of `size`, by leaving out parts of the drive
  double cost_ratio = 1;                 ///< of the least cost taken otherwise to that as given
};

/// The change of the answer from a sample of short motions, weighted by their residuals at T_a_b as the
/// estimator weights those of each stride, when they are taken from `otherwise`: the same instants, or nearly
/// so. Empty where there are too few motions.
std::optional<AnswerChange> answer_change(const Instants& given, const Instants& otherwise,
                                          const DualQuaternion& T_a_b, const AnswerChangeOptions& options);

/// The streams where neither has more than most_poses: all, or the middle of a long drive. Whatever is
/// counted in parts of a millisecond shows there.
struct MiddlePart {
  Trajectory a, b;
};
MiddlePart middle_part(const Trajectory& a, const Trajectory& b, std::size_t most_poses);

}  // namespace egocal::detail
