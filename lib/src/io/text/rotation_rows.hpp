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

/// Whether the fields from `first` on are the numbers of a 3 x 4 or 4 x 4 pose matrix, row by row.
bool looks_like_pose_matrix(const std::vector<std::string_view>& fields, std::size_t first);

}  // namespace egocal::detail
