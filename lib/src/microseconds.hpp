// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace egocal::detail {

inline constexpr double second_us = 1e6;  ///< unit

inline double seconds(std::int64_t us) {
  return 1e-6 * static_cast<double>(us);
}

}  // namespace egocal::detail
