// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/judged_answer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace egocal::services {

double deviations_from(const JudgedAnswer& judged, const DualQuaternion& T_a_b) {
  const Pose now = to_pose(T_a_b);
  const Eigen::Vector3d turned = rotation_log(now.rotation * judged.T_a_b.rotation.conjugate());
  const Eigen::Vector3d shifted = now.translation - judged.T_a_b.translation;
  double largest = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!judged.observability.observable[i]) continue;
    const auto axis = static_cast<Eigen::Index>(i % 3);
    const double difference = std::abs(i < 3 ? shifted[axis] : turned[axis]);
    if (const double stddev = judged.observability.stddev[i]; stddev > 0)
      largest = std::max(largest, difference / stddev);
  }
  return largest;
}

}  // namespace egocal::services
