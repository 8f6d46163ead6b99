// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Angles are in radians everywhere but in files of degrees and in what people read.
#pragma once

#include <numbers>

namespace egocal {

inline constexpr double degrees_per_radian = 180 / std::numbers::pi;
inline constexpr double radians_per_degree = std::numbers::pi / 180;

}  // namespace egocal
