// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/possible_changes.hpp"

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "egocal/geometry/dual_quaternion.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

bool possible_change(const Finding& finding) {
  return !finding.certain && finding.T_a_b &&
         (finding.code == "mount_moved" || finding.code == "scale_change");
}

void add_possible_changes(Answered& answered, Diagnosis& result) {
  Vector6d moved = Vector6d::Zero();
  for (const Finding& finding : result.findings)
    if (possible_change(finding))
      moved =
          moved.cwiseMax(frame_a_difference(answered.T_a_b, to_dual_quaternion(*finding.T_a_b)).cwiseAbs());
  for (std::size_t i = 0; i < 6; ++i)
    if (const double size = moved[static_cast<Eigen::Index>(i)];
        size > 0 && answered.observability.observable[i])
      answered.timing_stddev[i] = std::hypot(answered.timing_stddev[i], size);
  result.timing_stddev = answered.timing_stddev;
}

}  // namespace egocal::detail
