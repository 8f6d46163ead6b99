// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/geometry/dual_quaternion.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/uncertainty/directions.hpp"

namespace egocal::services {

/// The answer that a verdict is about.
struct JudgedAnswer {
  Pose T_a_b;
  Observability observability;  ///< as_judged()
};

/// How far an answer is from a judged one: the largest difference in an observable direction, in standard
/// deviations stated with the judged answer. 0 if no direction was observable.
double deviations_from(const JudgedAnswer& judged, const DualQuaternion& T_a_b);

}  // namespace egocal::services
