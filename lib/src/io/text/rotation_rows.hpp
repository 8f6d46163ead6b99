// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace egocal::detail {

/// Whether the matrix is a rotation, within what a few printed digits leave.
bool is_rotation(const Eigen::Matrix3d& R);

/// Whether a number is that of 0 0 0 1, the last row of a 4 x 4 pose, to the rounding of products in single
/// precision. column: 0 to 3.
bool is_of_last_row(double value, std::size_t column);

/// Whether the fields from `first` on are the numbers of a 3 x 4 or 4 x 4 pose matrix, row by row.
bool looks_like_pose_matrix(const std::vector<std::string_view>& fields, std::size_t first);

}  // namespace egocal::detail
