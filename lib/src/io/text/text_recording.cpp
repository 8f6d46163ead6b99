// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/text_recording.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "io/checked_pose.hpp"
#include "io/text/geodesy.hpp"
#include "io/text/line_reader.hpp"
#include "io/text/rotation_rows.hpp"

namespace egocal::detail {

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double metres_a_degree = 111e3;  // of latitude, roughly: directions need no more

bool is_data(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first != std::string_view::npos && line[first] != '#' && line[first] != '%';
}

}  // namespace

/// The rows of the file, one at a time.
struct TextRecording::Rows {
  Rows(ByteSource& source, const TextLayout& text_layout) : lines(source), layout(text_layout) {
    if (layout.matrix && layout.times) stamp = 0;
    if (!layout.matrix && layout.columns.has(Quantity::time)) stamp = layout.columns[Quantity::time].index;
  }

  bool next() {
    std::string_view line;
    while (lines.next(line)) {
      if (lines.number() == layout.header_line || !is_data(line)) continue;
      if (layout.decimal_comma) {
        points.assign(line);
        std::replace(points.begin(), points.end(), ',', '.');
        line = points;
      }
      if (layout.separator != ' ' || !split_numbers(line)) {
        numbers.clear();
        split(line, layout.separator, fields);
      }
      width = layout.separator == ' '
                  ? fields.size()
                  : static_cast<std::size_t>(std::count(line.begin(), line.end(), layout.separator)) + 1;
      ++count;
      return true;
    }
    return false;
  }

  /// split() at blanks of a row of numbers, which are read on the way: a field ends where its number does.
  /// False where one is none.
  bool split_numbers(std::string_view line) {
    fields.clear();
    numbers.clear();
    const char* at = line.data();
    const char* const end = at + line.size();
    while (true) {
      while (at != end && *at == ' ') ++at;
      if (at == end) return true;
      const char* const begin = at;
      double number = 0;
      if (fields.size() == stamp) {
        while (at != end && *at != ' ' && *at != '\t' && *at != '\r') ++at;
      } else {
        const auto [behind, error] = std::from_chars(begin, end, number);
        if (error != std::errc() || !std::isfinite(number)) return false;
        at = behind;
      }
      if (at != end && *at != ' ') return false;
      fields.emplace_back(begin, static_cast<std::size_t>(at - begin));
      numbers.push_back(number);
    }
  }

  /// The finite number in this field, which is there.
  std::optional<double> number(std::size_t index) const {
    double value = 0;
    if (index < numbers.size() && index != stamp) return numbers[index];
    if (!parse_number(fields[index], value) || !std::isfinite(value)) return std::nullopt;
    return value;
  }

  LineReader lines;
  const TextLayout& layout;
  std::vector<std::string_view> fields;
  std::vector<double> numbers;   ///< of the fields; empty where they are not all numbers
  std::size_t stamp = SIZE_MAX;  ///< field that is read as text, for a double cannot hold nanoseconds
  std::string points;
  std::size_t count = 0;  ///< rows so far
  std::size_t width = 0;  ///< fields of this row, empty ones at its end included
};

TextRecording::TextRecording(std::unique_ptr<ByteSource> source, ReadOptions options)
    : Recording(source->file()), source_(std::move(source)), options_(std::move(options)) {
  layout_ = detect_layout(*source_, options_);
  if (!options_.times_file.empty()) {
    if (!layout_.matrix || layout_.first_column != 0)
      throw error_at(file_, 0, "",
                     "a file of times belongs to KITTI poses (12 fields a line), this is not one");
    read_times();
  }
  if (options_.rate != 0 && !rates_of_poses.contains(options_.rate))
    throw error_at(file_, 0, "--rate", "expected 0.001 to 1e6 Hz");
  if (options_.rate > 0) rate_ = options_.rate;
  find_angle_unit();
  if (layout_.columns.has(Quantity::heading) && !layout_.columns.has_quaternion() &&
      !layout_.columns.has(Quantity::yaw) && !layout_.columns.has_geodetic())
    layout_.notes.push_back("heading is taken clockwise from north (y); call the column yaw if it is not");
}

void TextRecording::read_times() {
  ByteSource source(options_.times_file);
  const std::string& file = options_.times_file;
  ReadOptions one_column;
  LineReader lines(source);
  std::string_view line;
  std::vector<std::string_view> fields;
  while (lines.next(line)) {
    if (!is_data(line)) continue;
    split(line, ' ', fields);
    if (fields.size() != 1)
      throw error_at(file, lines.number(), "",
                     "expected one time, got " + std::to_string(fields.size()) + " fields");
    double size = 0;
    const bool epoch_ns = parse_number(fields[0], size) && std::abs(size) > 4.1e15;
    times_.push_back(
        time_us(file, lines.number(), fields[0], epoch_ns ? TimeUnit::nanoseconds : TimeUnit::seconds));
  }
  if (times_.empty()) throw error_at(file, 0, "", "holds no data");
}

/// All of the file counts: a drive may begin straight.
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
  if (*decision.degrees) angle_in_si_ = degree;
  layout_.notes.push_back(std::string("angles are taken as ") + (*decision.degrees ? "degrees" : "radians") +
                          ", " + decision.reason);
}

/// What the rows tell about the unit of these angles.
AngleUnit TextRecording::unit_by_rows(const std::vector<Quantity>& angles) {
  using enum Quantity;
  const ColumnMap& columns = layout_.columns;
  AngleUnit unit;
  Rows rows(*source_, layout_);
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
      position = Eigen::Vector2d(*along * std::cos(*at * degree), *at) * metres_a_degree;
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

/// Of a row that may be unreadable, then 0.
double TextRecording::seconds_of_row(const Rows& rows) const {
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
  Rows rows(*source_, layout_);
  while (rows.next()) {
    const std::optional<StampedPose> pose = pose_of_row(rows);
    if (pose) {
      ++streams_[0].messages;
      take(0, *pose);
    }
  }
  source_->count_unpacking(losses_);
  if (rows.count == 0) throw error_at(file_, 0, "", "holds no data");
  if (!times_.empty() && times_.size() != rows.count)
    throw error_at(options_.times_file, 0, "",
                   "expected " + std::to_string(rows.count) + " times, one for each pose of " + file_ +
                       ", got " + std::to_string(times_.size()));
  if (!layout_.times && times_.empty()) {
    char rate[32];
    std::snprintf(rate, sizeof rate, "%g", rate_);
    notes_.push_back(std::string("the poses have no times: ") + rate + " Hz " +
                     (options_.rate > 0 ? "as given" : "assumed (--rate, or --times FILE)"));
  }
}

std::vector<std::string> TextRecording::unused(const ReadOptions& options) const {
  if (!(options.rate > 0) || (!layout_.times && times_.empty())) return {};
  return {"--rate is not used: the poses have times"};
}

/// Empty: the row is skipped and counted.
std::optional<StampedPose> TextRecording::pose_of_row(const Rows& rows) {
  const std::size_t n = rows.fields.size();
  const auto empty_field = [&] {
    if (losses_.refused++ == 0)
      losses_.first_refused = "line " + std::to_string(rows.lines.number()) + ": an empty field";
    return std::nullopt;
  };
  if (layout_.format == "table" && n < layout_.fields && rows.width >= layout_.fields) return empty_field();
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
  if (layout_.header_line > 0 && options_.columns.empty() && n > layout_.names.size())
    throw error_at(file_, rows.lines.number(), "",
                   "expected " + std::to_string(layout_.names.size()) +
                       " fields, as the header has names, got " + std::to_string(n) +
                       (layout_.separator == ',' ? "; write decimals with a point, or" : ";") +
                       " name the columns with --columns t,x,y,z,qx,qy,qz,qw");
  if (layout_.format == "table")
    for (const auto& column : layout_.columns.of)
      if (column && rows.fields[column->index].empty()) return empty_field();
  StampedPose pose;
  pose.time_us = time_of_row(rows);
  if (!layout_.matrix && !layout_.columns.has_pose()) {
    const std::optional<DualQuaternion> integrated = pose_of_twist(rows, pose.time_us);
    if (!integrated) {
      if (losses_.refused++ == 0)
        losses_.first_refused =
            "line " + std::to_string(rows.lines.number()) + ": a velocity that is not later";
      return std::nullopt;
    }
    pose.pose = *integrated;
    return pose;
  }
  pose.pose = layout_.matrix ? pose_of_matrix(rows) : pose_of_columns(rows);
  return pose;
}

std::int64_t TextRecording::time_of_row(const Rows& rows) const {
  const long line = rows.lines.number();
  if (!times_.empty()) return rows.count <= times_.size() ? times_[rows.count - 1] : 0;
  if (!layout_.times) {
    const double frame = layout_.index ? value(rows, 0) : static_cast<double>(rows.count - 1);
    return std::llround(frame / rate_ * 1e6);
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

double TextRecording::value(const Rows& rows, std::size_t index) const {
  const std::optional<double> number = rows.number(index);
  if (!number) {
    constexpr const char* matrix[] = {"r11", "r12", "r13", "tx", "r21", "r22", "r23", "ty",
                                      "r31", "r32", "r33", "tz", "0",   "0",   "0",   "1"};
    const std::string name =
        layout_.matrix ? (index >= layout_.first_column ? matrix[index - layout_.first_column] : "time")
                       : (index < layout_.names.size() ? layout_.names[index] : "");
    const std::string field = "field " + std::to_string(index + 1) + " (" + name.substr(0, 100) + ")";
    if (rows.count == 1 && !layout_.matrix && layout_.format != "table" &&
        !has_decimal_comma(rows.fields[index]))
      throw error_at(file_, rows.lines.number(), field,
                     "expected a number, got " + quoted(rows.fields[index]) +
                         "; name the columns with --columns t,x,y,z,qx,qy,qz,qw (- for others)");
    throw_not_a_number(file_, rows.lines.number(), field, rows.fields[index]);
  }
  return *number;
}

double TextRecording::value(const Rows& rows, Quantity quantity, double in_si) const {
  if (!layout_.columns.has(quantity)) return 0;
  const ColumnMap::Column& column = layout_.columns[quantity];
  return value(rows, column.index) * column.in_si.value_or(in_si);
}

double TextRecording::angle(const Rows& rows, Quantity quantity) const {
  return value(rows, quantity, angle_in_si_);
}

DualQuaternion TextRecording::pose_of_matrix(const Rows& rows) const {
  double v[12];
  for (std::size_t i = 0; i < 12; ++i) v[i] = value(rows, layout_.first_column + i);
  Eigen::Matrix3d R;
  R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  if (!is_rotation(R)) throw error_at(file_, rows.lines.number(), "", "the 3 x 3 part is not a rotation");
  const Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
  const CheckedPose pose = checked_pose({v[3], v[7], v[11]}, {q.w(), q.x(), q.y(), q.z()});
  if (!pose.reason.empty()) throw error_at(file_, rows.lines.number(), "", pose.reason);
  return pose.pose;
}

/// Empty: the time does not increase.
std::optional<DualQuaternion> TextRecording::pose_of_twist(const Rows& rows, std::int64_t time_us) {
  using enum Quantity;
  Twist twist;
  twist.time_us = time_us;
  twist.linear = {value(rows, vx), value(rows, vy), value(rows, vz)};
  twist.angular = {angle(rows, wx), angle(rows, wy), angle(rows, wz)};
  return integrator_.add(twist);
}

DualQuaternion TextRecording::pose_of_columns(const Rows& rows) {
  using enum Quantity;
  const ColumnMap& columns = layout_.columns;
  const long line = rows.lines.number();
  Eigen::Vector4d q;
  Eigen::Vector3d t{value(rows, x), value(rows, y),
                    value(rows, z)};  // braces: the first bad field is reported
  if (columns.has_quaternion()) {
    q = {value(rows, qw), value(rows, qx), value(rows, qy), value(rows, qz)};
  } else {
    // mathematical yaw, or a heading clockwise from north in a frame of east and north
    const double about_z = columns.has(yaw) ? angle(rows, yaw) : std::numbers::pi / 2 - angle(rows, heading);
    const Eigen::Quaterniond R = rotation_exp({0, 0, about_z}) * rotation_exp({0, angle(rows, pitch), 0}) *
                                 rotation_exp({angle(rows, roll), 0, 0});
    q = {R.w(), R.x(), R.y(), R.z()};
  }
  if (columns.has_geodetic() && !columns.has_position()) {
    const GeodeticPosition place{value(rows, latitude, degree), value(rows, longitude, degree),
                                 value(rows, height)};
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
  const CheckedPose pose = checked_pose(t, q);
  if (!pose.reason.empty()) throw error_at(file_, line, "", pose.reason);
  return pose.pose;
}

}  // namespace egocal::detail
