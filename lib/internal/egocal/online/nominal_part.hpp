// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A nominal value of which only a part was measured, as a height by a ruler. It is a pose with NaN for what
// is not known: any of x, y and z, or the rotation.
#pragma once

#include <optional>
#include <string>

#include "egocal/geometry/pose.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal {

/// Whether something is not known.
bool is_part(const Pose& nominal);

/// What is known: "z", "x, y, rotation".
std::string known_in_words(const Pose& nominal);

/// What keeps a part from being one that can be used, as of a list "[x, y, z, qw, qx, qy, qz]"; empty:
/// nothing. All of the quaternion is known or nothing of it, and something of the pose is.
std::string wrong_with_part(const Pose& nominal);

struct NominalPartOptions {
  /// Least length of what the part shows of a unit combination of hidden directions (mathematics). An error
  /// of 1 in the part then moves the answer by 2 at most: a height is measured along an axis that leans by
  /// less than 60 degrees.
  double least_seen = 0.5;
};

/// Which of the two sensors' frames a nominal value is in.
enum class NominalOf { b_in_a, a_in_b };

/// The whole nominal value for Problem::prior, b in a, that agrees with the part in what is known and with
/// the answer in what the motions show: what they hide is moved to the part. Empty where the part does not
/// give all that they hide. problem: without a prior; T_a_b: its answer.
std::optional<DualQuaternion> completed_nominal(const Pose& part, const Problem& problem,
                                                const DualQuaternion& T_a_b, NominalOf of = NominalOf::b_in_a,
                                                const NominalPartOptions& options = {});

}  // namespace egocal
