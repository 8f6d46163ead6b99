// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace egocal::tools {

inline constexpr double degrees = 180 / std::numbers::pi;  ///< of a radian

}  // namespace egocal::tools
