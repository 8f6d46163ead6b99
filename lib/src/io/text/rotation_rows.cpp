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

bool is_of_last_row(double value, std::size_t column) {
  constexpr double rounding = 1e-6;  // eight times the last digit of a float near 1, after some products
  return std::abs(value - (column == 3 ? 1 : 0)) < rounding;
}

bool looks_like_pose_matrix(const std::vector<std::string_view>& fields, std::size_t first) {
  double v[16] = {};
  const std::size_t count = fields.size() - first;
  for (std::size_t i = 0; i < count; ++i)
    if (!parse_number(fields[first + i], v[i])) return false;
  Eigen::Matrix3d R;
  R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  bool last_row = true;
  for (std::size_t i = 12; i < count; ++i) last_row = last_row && is_of_last_row(v[i], i - 12);
  return is_rotation(R) && last_row;
}

}  // namespace egocal::detail
