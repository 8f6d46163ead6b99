// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What values from files, messages and options must obey. One place for all of them, so that a trajectory
// which is accepted from a file can be sent, and a message that is accepted cannot overflow later arithmetic.
#pragma once

#include <cmath>
#include <cstdint>

namespace egocal {

/// A closed range of an option or a value.
struct Range {
  double least = 0, most = 0;
  /// Whether the range holds the value; false for NaN, too.
  constexpr bool contains(double value) const { return value >= least && value <= most; }
};

namespace limits {

/// 1970-01-01 and 2100-01-01 [us]. Times that count from another event than 1970 (relative times) begin at
/// zero and stay far below.
inline constexpr std::int64_t earliest_us = 0;
inline constexpr std::int64_t latest_us = 4'102'444'800'000'000;

/// Largest absolute coordinate of a pose in its odometry frame [m]. Beyond it a double resolves no
/// micrometres.
inline constexpr double largest_distance = 1e9;

/// How far the length of a rotation's quaternion may be from 1: what a few printed digits leave.
inline constexpr double unit_tolerance = 0.01;

/// Sequence numbers and counts: doubles hold them exactly, and adding to them does not overflow.
inline constexpr std::int64_t largest_count = std::int64_t{1} << 53;

inline constexpr Range max_gap{1e-3, 3600};  ///< [s]
/// [s] Between two times of the wire: one clock may count from 1970, the other from the start of a machine.
inline constexpr Range time_offset{-1e-6 * latest_us, 1e-6 * latest_us};
inline constexpr Range t_no_fail{0, 1e6};            ///< [s]
inline constexpr Range stride{1, 10'000};            ///< steps of the slower stream
inline constexpr Range rotation_weight{0, 1e12};     ///< Balance::rotation
inline constexpr Range translation_weight{0, 1e12};  ///< Balance::translation; zero itself is not allowed

}  // namespace limits

/// Whether a time on the wire is plausible: a date.
constexpr bool plausible_time(std::int64_t time_us) {
  return time_us >= limits::earliest_us && time_us <= limits::latest_us;
}

/// Whether a time in files or inside the library is plausible: a date or a relative time, which an offset may
/// have moved below zero.
constexpr bool plausible_relative_time(std::int64_t time_us) {
  return time_us >= -limits::latest_us && time_us <= limits::latest_us;
}

/// Whether a sequence number is plausible; -1, an unknown one where a message allows it, is not.
constexpr bool plausible_count(std::int64_t count) {
  return count >= 0 && count <= limits::largest_count;
}

/// Whether a distance or coordinate is plausible; false for NaN and infinity, too.
inline bool plausible_distance(double metres) {
  return std::abs(metres) <= limits::largest_distance;
}

/// Whether the length of a rotation's quaternion is plausible.
inline bool plausible_norm(double norm) {
  return std::abs(norm - 1) <= limits::unit_tolerance;
}

}  // namespace egocal
