// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/rotation_rows.hpp"

#include <Eigen/LU>
#include <cmath>

#include "egocal/limits.hpp"
#include "io/text.hpp"

namespace egocal::detail {

bool is_rotation(const Eigen::Matrix3d& R) {
  // negated: products of large numbers are not even comparable
  return (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() <= limits::unit_tolerance &&
         R.determinant() > 0;
}

bool looks_like_pose_matrix(const std::vector<std::string_view>& fields, std::size_t first) {
  double v[16] = {};
  const std::size_t count = fields.size() - first;
  for (std::size_t i = 0; i < count; ++i)
    if (!parse_number(fields[first + i], v[i])) return false;
  Eigen::Matrix3d R;
  R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  constexpr double rounding = 1e-6;  // of products of matrices in single precision
  const auto near = [](double value, double expected) { return std::abs(value - expected) < rounding; };
  return is_rotation(R) &&
         (count == 12 || (near(v[12], 0) && near(v[13], 0) && near(v[14], 0) && near(v[15], 1)));
}

}  // namespace egocal::detail
