// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/contents/without_lever_arms.hpp"

#include <algorithm>
#include <vector>

#include "diagnosis/motions/stillest_point.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

Explained without_lever_arms(const Explained& explained, double length) {
  constexpr double rounding = 1e-16;  // of the unit, squared: eight digits of a pose
  std::vector<BodyMotion> a, b;
  for (const Motion& motion : explained.motions.all) {
    a.push_back({motion.R_a, motion.t_a});
    b.push_back({rotation_of(motion.b), motion.t_b});
  }
  const Eigen::Quaterniond R = to_pose(explained.fit.T).rotation;
  const std::vector<Eigen::Vector3d> of_a = at_stillest_point(a), of_b = at_stillest_point(b);
  // the two points may be different ones
  for (std::size_t i = 0; i < a.size(); ++i) a[i].t = of_a[i] - R * of_b[i];
  Explained result{explained.motions, {}};
  result.fit.T = explained.fit.T;
  const double unit = length > 0 ? length : 1;
  for (const Eigen::Vector3d& residual : at_stillest_point(a))
    result.fit.squares.push_back(residual.squaredNorm() / (unit * unit));
  result.fit.weights = explained.fit.weights;
  result.fit.typical = std::max(median(result.fit.squares), rounding);
  return result;
}

}  // namespace egocal::detail
