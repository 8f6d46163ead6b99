// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/text_recording.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "egocal/degrees.hpp"
#include "egocal/error.hpp"
#include "egocal/io/checked_pose.hpp"
#include "egocal/io/misplaced_times.hpp"
#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "io/text/geodesy.hpp"
#include "io/text/rotation_rows.hpp"
#include "io/text/text_rows.hpp"
#include "io/text/times_file.hpp"

namespace egocal::detail {

namespace {

constexpr double metres_a_degree = 111e3;  // of latitude, roughly: directions need no more

}  // namespace

TextRecording::TextRecording(std::unique_ptr<ByteSource> source, ReadOptions options)
    : Recording(source->file()), source_(std::move(source)), options_(std::move(options)) {
  source_->read_content([this] { find_layout(); });
}

void TextRecording::find_layout() {
  layout_ = detect_layout(*source_, options_);
  if (!options_.times_file.empty()) {
    if (layout_.times)
      throw MisplacedTimes(
          error_at(file_, 0, "",
                   "its poses have times of their own; a file of times belongs to poses without, "
                   "such as those of KITTI (12 fields a line)"));
    times_ = read_times_file(options_.times_file);
  }
  if (options_.rate != 0 && !rates_of_poses.contains(options_.rate))
    throw error_at(file_, 0, "--rate", "expected 0.001 to 1e6 Hz");
  if (options_.rate > 0) rate_ = options_.rate;
  find_angle_unit();
  if (layout_.columns.has_compass_angles())
    layout_.notes.push_back(
        std::string("heading is taken clockwise from north (y)") +
        (layout_.columns.has(Quantity::pitch) || layout_.columns.has(Quantity::roll)
             ? ", pitch with the nose up and roll with the right side down, as GNSS/INS devices give them; "
               "the poses are those of axes x forward, y left, z up"
             : "") +
        "; call the column yaw if it is not");
}

/// Finds the unit of the angles by all of the file: a drive may begin straight.
void TextRecording::find_angle_unit() {
  using enum Quantity;
  if (layout_.columns.has_quaternion()) return;
  std::vector<Quantity> unknown;
  std::optional<Quantity> named;
  for (const Quantity quantity : {roll, pitch, yaw, heading, wx, wy, wz}) {
    if (!layout_.columns.has(quantity)) continue;
    const std::optional<double>& in_si = layout_.columns[quantity].in_si;
    if (!in_si) unknown.push_back(quantity);
    if (in_si && named && layout_.columns[*named].in_si != in_si) throw unit_of_angles_needed(unknown);
    if (in_si) named = quantity;
  }
  if (unknown.empty()) return;
  if (named) {
    angle_in_si_ = *layout_.columns[*named].in_si;
    layout_.notes.push_back("the other angles are taken in the unit of " +
                            layout_.names[layout_.columns[*named].index]);
    return;
  }
  const AngleUnit::Decision decision = unit_by_rows(unknown).decide();
  if (!decision.degrees) throw unit_of_angles_needed(unknown);
  if (*decision.degrees) angle_in_si_ = radians_per_degree;
  layout_.notes.push_back(std::string("angles are taken as ") + (*decision.degrees ? "degrees" : "radians") +
                          ", " + decision.reason);
}

/// What the rows tell about the unit of these angles.
AngleUnit TextRecording::unit_by_rows(const std::vector<Quantity>& angles) {
  using enum Quantity;
  const ColumnMap& columns = layout_.columns;
  AngleUnit unit;
  TextRows rows(*source_, layout_);
  while (rows.next()) {
    const auto number = [&](Quantity quantity) -> std::optional<double> {
      if (!columns.has(quantity) || columns[quantity].index >= rows.fields.size()) return std::nullopt;
      return rows.number(columns[quantity].index);
    };
    // reading refuses rows that cannot be read; here they tell nothing
    std::optional<Eigen::Vector2d> position;
    if (const auto east = number(x), north = number(y); east && north)
      position = Eigen::Vector2d(*east, *north) * columns[x].in_si.value_or(1);
    else if (const auto at = number(latitude), along = number(longitude); at && along)
      position = Eigen::Vector2d(*along * std::cos(*at * radians_per_degree), *at) * metres_a_degree;
    for (const Quantity quantity : angles) {
      const std::optional<double> angle = number(quantity);
      if (!angle) continue;
      if (quantity == yaw || quantity == heading)
        unit.add(seconds_of_row(rows), position, *angle);
      else
        unit.add_other(*angle);
    }
  }
  source_->rewind();
  return unit;
}

/// Time of a row [s]; 0 where the row is unreadable.
double TextRecording::seconds_of_row(const TextRows& rows) const {
  if (rows.fields.size() < layout_.fields) return 0;
  try {
    return to_seconds(time_of_row(rows));
  } catch (const Error&) {
    return 0;
  }
}

Error TextRecording::unit_of_angles_needed(const std::vector<Quantity>& angles) const {
  std::string names;
  for (std::size_t i = 0; i < layout_.names.size(); ++i) {
    std::string name = layout_.names[i];
    for (const Quantity quantity : angles)
      if (layout_.columns[quantity].index == i) name += "[rad]";
    names += (names.empty() ? "" : ",") + name;
  }
  constexpr std::size_t longest = 200;  // limit of what people read
  if (names.size() > longest) names = "t,x,y,z,roll[rad],pitch[rad],yaw[rad]";
  return error_at(file_, layout_.header_line, layout_.names[layout_.columns[angles.back()].index],
                  "cannot tell whether its angles are degrees or radians whose turns are summed; name the "
                  "unit, [rad] or [deg]: --columns '" +
                      names + "'");
}

void TextRecording::read(const std::string& topic, const TakePose& take) {
  if (!topic.empty())
    throw error_at(file_, 0, "",
                   "is a file of format " + layout_.format + " without topics, got ':" + topic + "'");
  if (read_before_) source_->rewind();
  read_before_ = true;
  streams_.assign(1, {});
  streams_[0].type = layout_.format;
  streams_[0].poses = true;
  losses_ = {};
  notes_ = layout_.notes;
  T_earth_origin_.reset();
  integrator_ = {};
  if (!layout_.matrix && !layout_.columns.has_pose())
    notes_.push_back("poses are integrated from the velocities in the frame of the sensor");
  TextRows rows(*source_, layout_);
  source_->read_content([&] { read_rows(rows, take); });
  source_->count_unpacking(losses_);
  if (rows.count == 0) throw error_at(file_, 0, "", source_->why_empty());
  if (!times_.empty() && times_.size() != rows.count)
    throw error_at(options_.times_file, 0, "",
                   "expected " + std::to_string(rows.count) + " times, one for each pose of " + file_ +
                       ", got " + std::to_string(times_.size()));
  if (!layout_.times && times_.empty()) {
    char rate[32];
    std::snprintf(rate, sizeof rate, "%g", rate_);
    notes_.push_back(std::string("the poses have no times: ") + rate + " Hz " +
                     (options_.rate > 0 ? "as given"
                      : layout_.named   ? "assumed (--rate)"
                                        : "assumed (--rate, or --times FILE)"));
  }
}

void TextRecording::read_rows(TextRows& rows, const TakePose& take) {
  while (rows.next()) {
    std::optional<StampedPose> pose;
    try {
      pose = pose_of_row(rows);
    } catch (const Error&) {
      if (!may_end_in_a_cut_number(rows)) throw;
      losses_.truncated = true;
    }
    if (pose) {
      ++streams_[0].messages;
      take(0, *pose);
    }
  }
}

std::vector<std::string> TextRecording::unused(const ReadOptions& options) const {
  if (!(options.rate > 0) || (!layout_.times && times_.empty())) return {};
  return {"--rate is not used: the poses have times"};
}

/// Whether a last row without a line end may be cut off within its last number: it has all fields, and
/// numbers in all but perhaps the last.
bool TextRecording::may_end_in_a_cut_number(const TextRows& rows) const {
  const std::size_t n = rows.fields.size();
  if (rows.lines.terminated() || rows.count < 2 || n != std::max(layout_.fields, layout_.names.size()))
    return false;
  for (std::size_t i = 0; i + 1 < n; ++i)
    if (!rows.number(i)) return false;
  return true;
}

/// The pose of a row; empty where the row is skipped and counted.
std::optional<StampedPose> TextRecording::pose_of_row(const TextRows& rows) {
  const std::size_t n = rows.fields.size();
  const auto skip = [&](const char* why) {
    if (losses_.refused++ == 0)
      losses_.first_refused = "line " + std::to_string(rows.lines.number()) + ": " + why;
    return std::nullopt;
  };
  constexpr const char* empty_field = "an empty field";
  if (layout_.named && n < layout_.fields && rows.width >= layout_.fields) return skip(empty_field);
  if (layout_.more_fields ? n < layout_.fields : n != layout_.fields) {
    if (!rows.lines.terminated() && n < layout_.fields && rows.count > 1) {
      losses_.truncated = true;
      return std::nullopt;
    }
    std::string expected;
    for (const std::string& name : layout_.names) expected += (expected.empty() ? "" : " ") + name;
    if (expected.size() > 200) expected = expected.substr(0, 200) + "...";
    throw error_at(file_, rows.lines.number(), "",
                   std::string("expected ") + (layout_.more_fields ? "at least " : "") +
                       std::to_string(layout_.fields) + " fields" +
                       (layout_.matrix ? " (3 x 4 pose)" : " (" + expected + ")") + ", got " +
                       std::to_string(n) +
                       (rows.count == 1 && !layout_.matrix ? "; name other columns with --columns" : ""));
  }
  // between blanks a missing field cannot be seen: those behind it would be read as others
  const bool too_few = layout_.separator == ' ' && n < layout_.names.size();
  if (layout_.header_line > 0 && options_.columns.empty() && (too_few || n > layout_.names.size())) {
    if (too_few && !rows.lines.terminated() && rows.count > 1) {
      losses_.truncated = true;
      return std::nullopt;
    }
    throw error_at(file_, rows.lines.number(), "",
                   "expected " + std::to_string(layout_.names.size()) +
                       " fields, as the header has names, got " + std::to_string(n) +
                       (too_few                    ? "; separate them with tabs or commas, or"
                        : layout_.separator == ',' ? "; write decimals with a point, or"
                                                   : ";") +
                       " name the columns with --columns t,x,y,z,qx,qy,qz,qw");
  }
  if (layout_.named)
    for (const auto& column : layout_.columns.of)
      if (column && rows.fields[column->index].empty()) return skip(empty_field);
  if (rows.without_a_number()) return skip("a field without a number, such as nan");
  StampedPose pose;
  pose.time_us = time_of_row(rows);
  if (!layout_.matrix && !layout_.columns.has_pose()) {
    const std::optional<DualQuaternion> integrated = pose_of_twist(rows, pose.time_us);
    if (!integrated) {
      return skip("a velocity that is not later");
    }
    pose.pose = *integrated;
    return pose;
  }
  if (layout_.matrix) {
    pose.pose = pose_of_matrix(rows);
    return pose;
  }
  const CheckedPose checked = pose_of_columns(rows);
  if (checked.reason == zero_quaternion) return skip(zero_quaternion);
  if (!checked.reason.empty()) throw error_at(file_, rows.lines.number(), "", checked.reason);
  pose.pose = checked.pose;
  return pose;
}

std::int64_t TextRecording::time_of_row(const TextRows& rows) const {
  const long line = rows.lines.number();
  if (!times_.empty()) return rows.count <= times_.size() ? times_[rows.count - 1] : 0;
  if (!layout_.times) {
    const double frame = layout_.index ? value(rows, 0) : static_cast<double>(rows.count - 1);
    return to_microseconds(frame / rate_);
  }
  if (layout_.columns.has(Quantity::seconds)) {
    const auto part = [&](Quantity quantity, TimeUnit unit) {
      return time_us(file_, line, rows.fields[layout_.columns[quantity].index], unit);
    };
    return part(Quantity::seconds, TimeUnit::seconds) + part(Quantity::nanoseconds, TimeUnit::nanoseconds);
  }
  const std::size_t column = layout_.matrix ? 0 : layout_.columns[Quantity::time].index;
  return time_us(file_, line, rows.fields[column], layout_.unit);
}

double TextRecording::value(const TextRows& rows, std::size_t index) const {
  const std::optional<double> number = rows.number(index);
  if (!number) {
    constexpr const char* matrix[] = {"r11", "r12", "r13", "tx", "r21", "r22", "r23", "ty",
                                      "r31", "r32", "r33", "tz", "0",   "0",   "0",   "1"};
    const std::string name =
        layout_.matrix ? (index >= layout_.first_column ? matrix[index - layout_.first_column] : "time")
                       : (index < layout_.names.size() ? layout_.names[index] : "");
    const std::string field = "field " + std::to_string(index + 1) + " (" + name.substr(0, 100) + ")";
    if (rows.count == 1 && !layout_.matrix && !layout_.named && !has_decimal_comma(rows.fields[index]))
      throw error_at(file_, rows.lines.number(), field,
                     "expected a number, got " + quoted(rows.fields[index]) +
                         "; name the columns with --columns t,x,y,z,qx,qy,qz,qw (- for others)");
    throw_not_a_number(file_, rows.lines.number(), field, rows.fields[index]);
  }
  return *number;
}

double TextRecording::value(const TextRows& rows, Quantity quantity, double in_si) const {
  if (!layout_.columns.has(quantity)) return 0;
  const ColumnMap::Column& column = layout_.columns[quantity];
  return value(rows, column.index) * column.in_si.value_or(in_si);
}

double TextRecording::angle(const TextRows& rows, Quantity quantity) const {
  return value(rows, quantity, angle_in_si_);
}

/// 0 0 0 1 of a 4 x 4 pose; column by column the last four numbers hold the position.
void TextRecording::check_last_row(const TextRows& rows) const {
  for (std::size_t i = 12; layout_.first_column + i < layout_.fields; ++i) {
    const std::size_t index = layout_.first_column + i;
    if (is_of_last_row(value(rows, index), i - 12)) continue;
    throw error_at(file_, rows.lines.number(), "field " + std::to_string(index + 1),
                   "expected 0 0 0 1 at the end of a 4 x 4 pose, got " + quoted(rows.fields[index]) +
                       "; write the matrix row by row");
  }
}

DualQuaternion TextRecording::pose_of_matrix(const TextRows& rows) const {
  double v[12];
  for (std::size_t i = 0; i < 12; ++i) v[i] = value(rows, layout_.first_column + i);
  Eigen::Matrix3d R;
  R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  if (!is_rotation(R)) throw error_at(file_, rows.lines.number(), "", "the 3 x 3 part is not a rotation");
  check_last_row(rows);
  const Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
  const CheckedPose pose = checked_pose({v[3], v[7], v[11]}, {q.w(), q.x(), q.y(), q.z()});
  if (!pose.reason.empty()) throw error_at(file_, rows.lines.number(), "", pose.reason);
  return pose.pose;
}

/// The pose after a row of velocities; empty where the time does not increase.
std::optional<DualQuaternion> TextRecording::pose_of_twist(const TextRows& rows, std::int64_t time_us) {
  using enum Quantity;
  Twist twist;
  twist.time_us = time_us;
  twist.linear = {value(rows, vx), value(rows, vy), value(rows, vz)};
  twist.angular = {angle(rows, wx), angle(rows, wy), angle(rows, wz)};
  return integrator_.add(twist);
}

CheckedPose TextRecording::pose_of_columns(const TextRows& rows) {
  using enum Quantity;
  const ColumnMap& columns = layout_.columns;
  const long line = rows.lines.number();
  Eigen::Vector4d q;
  Eigen::Vector3d t{value(rows, x), value(rows, y),
                    value(rows, z)};  // braces: the first bad field is reported
  if (columns.has_quaternion()) {
    q = {value(rows, qw), value(rows, qx), value(rows, qy), value(rows, qz)};
    if (q.isZero()) return checked_pose(t, q);  // a lost pose is no origin either
  } else {
    // Mathematical angles, or those of a compass: axes forward, right, down in a frame of north, east, down.
    // With forward, left, up in east, north, up the sense of heading and pitch changes, that of roll does
    // not.
    const bool compass = columns.has_compass_angles();
    const double about_z = compass ? std::numbers::pi / 2 - angle(rows, heading) : angle(rows, yaw);
    const double about_y = compass ? -angle(rows, pitch) : angle(rows, pitch);
    const Eigen::Quaterniond R = rotation_exp({0, 0, about_z}) * rotation_exp({0, about_y, 0}) *
                                 rotation_exp({angle(rows, roll), 0, 0});
    q = {R.w(), R.x(), R.y(), R.z()};
  }
  if (columns.has_geodetic() && !columns.has_position()) {
    const GeodeticPosition place{value(rows, latitude, radians_per_degree),
                                 value(rows, longitude, radians_per_degree), value(rows, height)};
    if (!(std::abs(place.latitude) <= std::numbers::pi / 2 &&
          std::abs(place.longitude) <= 2 * std::numbers::pi))
      throw error_at(file_, line, "latitude, longitude", "expected at most 90 and 360 degrees");
    const Pose T_earth_local = east_north_up(place);
    if (!T_earth_origin_) T_earth_origin_ = T_earth_local;
    const Pose local = inverse(*T_earth_origin_) * T_earth_local;
    const Eigen::Quaterniond R = local.rotation * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    t = local.translation;
    q = {R.w(), R.x(), R.y(), R.z()};
  }
  return checked_pose(t, q);
}

}  // namespace egocal::detail
