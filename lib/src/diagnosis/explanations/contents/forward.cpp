// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/contents/forward.hpp"

#include <algorithm>
#include <vector>

#include "diagnosis/motions/stillest_point.hpp"
#include "linear_algebra/symmetric_eigen.hpp"

namespace egocal::detail {

namespace {

double sum_of_lengths(const std::vector<Eigen::Vector3d>& vectors) {
  double sum = 0;
  for (const Eigen::Vector3d& vector : vectors) sum += vector.norm();
  return sum;
}

/// Largest eigenvalue over the trace; of nothing 0.
double largest_part(const Eigen::Matrix3d& sum) {
  return sum.trace() > 0 ? symmetric_eigen<3>(sum).values.maxCoeff() / sum.trace() : 0;
}

/// Way of the point of each body that goes the shortest one [m].
struct Ways {
  double a = 0, b = 0;
};

Ways of_stillest_points(const Motions& motions) {
  std::vector<BodyMotion> a, b;
  for (const Motion& motion : motions.all) {
    a.push_back({motion.R_a, motion.t_a});
    b.push_back({rotation_of(motion.b), motion.t_b});
  }
  return {sum_of_lengths(at_stillest_point(a)), sum_of_lengths(at_stillest_point(b))};
}

}  // namespace

Heading heading(const Motions& motions) {
  Heading result;
  Eigen::Vector3d sum_a = Eigen::Vector3d::Zero(), sum_b = Eigen::Vector3d::Zero();
  Eigen::Matrix3d lines_a = Eigen::Matrix3d::Zero(), lines_b = lines_a;
  double length_a = 0, length_b = 0;
  for (const Motion& motion : motions.all) {
    // by length, but no single jump counts for more than a few motions
    const double limit = 4 * motions.translation;
    const double a = motion.t_a.norm(), b = motion.t_b.norm();
    if (a > 0 && a <= limit) {
      sum_a += motion.t_a;
      lines_a += motion.t_a * motion.t_a.transpose() / a;
      length_a += a;
    }
    if (b > 0 && b <= limit) {
      sum_b += motion.t_b;
      lines_b += motion.t_b * motion.t_b.transpose() / b;
      length_b += b;
    }
    result.turned += motion.angle_a;
  }
  result.way_a = length_a;
  result.way_b = length_b;
  if (length_a > 0) result.concentration_a = sum_a.norm() / length_a;
  if (length_b > 0) result.concentration_b = sum_b.norm() / length_b;
  result.line_a = largest_part(lines_a);
  result.line_b = largest_part(lines_b);
  return result;
}

bool along_one_line(const Heading& heading, const HeadingOptions& options) {
  return heading.turned > options.least_turning && std::min(heading.line_a, heading.line_b) > options.always;
}

bool forward(const Heading& heading, const HeadingOptions& options) {
  return heading.turned > options.least_turning &&
         std::min(heading.concentration_a, heading.concentration_b) > options.always;
}

bool scattered(const Heading& heading, const HeadingOptions& options) {
  return std::max(heading.concentration_a, heading.concentration_b) < options.seldom;
}

bool longer_way(const Motions& x, const Motions& y) {
  const Heading sensors_x = heading(x), sensors_y = heading(y);
  if (!(sensors_x.way_a > sensors_y.way_a && sensors_x.way_b > sensors_y.way_b)) return false;
  const Ways points_x = of_stillest_points(x), points_y = of_stillest_points(y);
  return points_x.a > points_y.a && points_x.b > points_y.b;
}

}  // namespace egocal::detail
