// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/forward.hpp"

#include <algorithm>

namespace egocal::detail {

Heading heading(const Motions& motions) {
  Heading result;
  Eigen::Vector3d sum_a = Eigen::Vector3d::Zero(), sum_b = Eigen::Vector3d::Zero();
  double length_a = 0, length_b = 0;
  for (const Motion& motion : motions.all) {
    // by length, but no single jump counts for more than a few motions
    const double limit = 4 * motions.translation;
    const double a = motion.t_a.norm(), b = motion.t_b.norm();
    if (a > 0 && a <= limit) {
      sum_a += motion.t_a;
      length_a += a;
    }
    if (b > 0 && b <= limit) {
      sum_b += motion.t_b;
      length_b += b;
    }
    result.turned += motion.angle_a;
  }
  if (length_a > 0) result.concentration_a = sum_a.norm() / length_a;
  if (length_b > 0) result.concentration_b = sum_b.norm() / length_b;
  return result;
}

bool forward(const Heading& heading, const HeadingOptions& options) {
  return heading.turned > options.least_turning &&
         std::min(heading.concentration_a, heading.concentration_b) > options.always;
}

bool scattered(const Heading& heading, const HeadingOptions& options) {
  return std::max(heading.concentration_a, heading.concentration_b) < options.seldom;
}

}  // namespace egocal::detail
