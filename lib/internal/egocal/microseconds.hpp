// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

namespace egocal {

inline constexpr double second_us = 1e6;  ///< unit

/// Seconds of a stamp or of a difference of stamps.
inline double to_seconds(std::int64_t us) {
  return 1e-6 * static_cast<double>(us);
}

/// Seconds between any two stamps, whose difference may be beyond the integers.
inline double seconds_between(std::int64_t from_us, std::int64_t to_us) {
  return 1e-6 * (static_cast<double>(to_us) - static_cast<double>(from_us));
}

/// Microseconds, rounded to the nearest integer.
inline std::int64_t to_microseconds(double seconds) {
  return std::llround(second_us * seconds);
}

}  // namespace egocal
