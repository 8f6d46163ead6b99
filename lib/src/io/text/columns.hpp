// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/text/units.hpp"

namespace egocal::detail {

/// What a column of a table can mean.
enum class Quantity {
  time,         ///< since 1970 or any other event
  seconds,      ///< whole seconds of a time in two columns ...
  nanoseconds,  ///< ... and the rest of it
  x,
  y,
  z,  ///< position
  qw,
  qx,
  qy,
  qz,
  roll,
  pitch,
  yaw,
  heading,  ///< clockwise from north
  latitude,
  longitude,
  height,
  vx,  ///< velocities in the frame of the sensor, for tables without poses
  vy,
  vz,
  wx,
  wy,
  wz,
  count_
};
inline constexpr std::size_t quantities = static_cast<std::size_t>(Quantity::count_);
Dimension dimension_of(Quantity quantity);
std::string_view to_string(Quantity quantity);

/// Which column holds which quantity, and in which unit where a header states it.
struct ColumnMap {
  struct Column {
    std::size_t index = 0;
    std::string unit{};                  ///< as in brackets behind the name; empty: not given
    std::optional<double> in_si{};       ///< of that unit; nothing: not given, or not known
    std::optional<std::size_t> rival{};  ///< a later column that may be the same quantity
  };
  std::array<std::optional<Column>, quantities> of;
  std::optional<std::size_t> other_time;  ///< a column with another time than that of the header

  bool has(Quantity quantity) const { return of[static_cast<std::size_t>(quantity)].has_value(); }
  const Column& operator[](Quantity quantity) const { return *of[static_cast<std::size_t>(quantity)]; }
  void set(Quantity quantity, std::size_t index) { of[static_cast<std::size_t>(quantity)] = Column{index}; }

  bool has_position() const;
  bool has_geodetic() const { return has(Quantity::latitude) && has(Quantity::longitude); }
  bool has_quaternion() const;
  bool has_attitude() const { return has_quaternion() || has(Quantity::yaw) || has(Quantity::heading); }
  /// A heading instead of a yaw: its roll and pitch are those of a vehicle in a frame of north, east, down.
  bool has_compass_angles() const {
    return has(Quantity::heading) && !has(Quantity::yaw) && !has_quaternion();
  }
  bool has_time() const { return has(Quantity::time) || has(Quantity::seconds); }
  bool has_pose() const { return (has_position() || has_geodetic()) && has_attitude(); }
  /// Whether there are velocities that are integrated to poses: speed and turning about the vertical axis at
  /// least.
  bool has_twist() const { return has(Quantity::vx) && has(Quantity::wz); }
  /// A pose can be made of it (times of poses can be made up).
  bool complete() const { return has_pose() || (has_twist() && has_time()); }
  /// What is missing, in words.
  std::string missing() const;
  /// Number of columns that a row needs at least.
  std::size_t width() const;
};

/// Finds the quantities by the names that people use: "t", "timestamp [ns]", "field.pose.pose.position.x",
/// "p_RS_R_x [m]", "q_w", "Yaw (deg)", "Latitude", ... Columns of other names are not used.
ColumnMap columns_from_names(const std::vector<std::string_view>& names);

/// Whether two columns have one name and unit, whatever the letters and brackets.
bool same_name(std::string_view one, std::string_view other);

}  // namespace egocal::detail
