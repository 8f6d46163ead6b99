// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/trajectory_file.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"
#include "io/text.hpp"

namespace egocal {

namespace {

using detail::fields;
using detail::Line;
using detail::number;

constexpr double largest_distance = 1e9;  // [m]; as on the wire

void require_distance(const std::string& file, long line, const Eigen::Vector3d& t) {
  if (t.cwiseAbs().maxCoeff() > largest_distance)
    throw error_at(file, line, "position", "expected less than 1e9 m");
}

/// x y z and a quaternion, in the order of the columns given.
DualQuaternion pose_of(const std::string& file, long line, const std::array<double, 3>& t,
                       const Eigen::Vector4d& q) {
  const double norm = q.norm();
  if (!(norm > 1e-6)) throw error_at(file, line, "quaternion", "is zero");
  if (std::abs(norm - 1) > 0.01)
    throw error_at(file, line, "quaternion", "expected length 1, got " + std::to_string(norm));
  const Eigen::Vector3d position(t[0], t[1], t[2]);
  require_distance(file, line, position);
  return to_dual_quaternion({Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized(), position});
}

std::vector<double> numbers(const std::string& file, const Line& line,
                            const std::vector<std::string_view>& columns, std::size_t first,
                            const std::vector<const char*>& names) {
  std::vector<double> values;
  for (std::size_t i = 0; i < names.size(); ++i)
    values.push_back(number(file, line.number,
                            "field " + std::to_string(first + i + 1) + " (" + names[i] + ")",
                            columns[first + i]));
  return values;
}

StampedPose tum_line(const std::string& file, const Line& line) {
  const auto columns = fields(line.text, false);
  if (columns.size() != 8)
    throw error_at(file, line.number, "",
                   "expected 8 fields (time tx ty tz qx qy qz qw), got " + std::to_string(columns.size()));
  const auto v = numbers(file, line, columns, 1, {"tx", "ty", "tz", "qx", "qy", "qz", "qw"});
  return {detail::time_us(file, line.number, columns[0], detail::TimeUnit::seconds),
          pose_of(file, line.number, {v[0], v[1], v[2]}, {v[6], v[3], v[4], v[5]})};
}

StampedPose euroc_line(const std::string& file, const Line& line) {
  const auto columns = fields(line.text, true);
  if (columns.size() < 8)
    throw error_at(file, line.number, "",
                   "expected at least 8 fields (time[ns], x, y, z, qw, qx, qy, qz), got " +
                       std::to_string(columns.size()));
  const auto v = numbers(file, line, columns, 1, {"x", "y", "z", "qw", "qx", "qy", "qz"});
  return {detail::time_us(file, line.number, columns[0], detail::TimeUnit::nanoseconds),
          pose_of(file, line.number, {v[0], v[1], v[2]}, {v[3], v[4], v[5], v[6]})};
}

DualQuaternion kitti_line(const std::string& file, const Line& line) {
  const auto columns = fields(line.text, false);
  if (columns.size() != 12)
    throw error_at(file, line.number, "",
                   "expected 12 fields (3 x 4 pose), got " + std::to_string(columns.size()));
  const auto v = numbers(file, line, columns, 0,
                         {"r11", "r12", "r13", "tx", "r21", "r22", "r23", "ty", "r31", "r32", "r33", "tz"});
  Eigen::Matrix3d R;
  R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  // negated: products of large numbers are not even comparable
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() <= 0.01 && R.determinant() > 0))
    throw error_at(file, line.number, "", "the 3 x 3 part is not a rotation");
  const Eigen::Vector3d position(v[3], v[7], v[11]);
  require_distance(file, line.number, position);
  return to_dual_quaternion({Eigen::Quaterniond(R).normalized(), position});
}

std::vector<std::int64_t> read_times(const std::string& file) {
  std::vector<std::int64_t> times;
  for (const Line& line : detail::read_lines(file)) {
    const auto columns = fields(line.text, false);
    if (columns.size() != 1)
      throw error_at(file, line.number, "",
                     "expected one time, got " + std::to_string(columns.size()) + " fields");
    times.push_back(detail::time_us(file, line.number, columns[0], detail::TimeUnit::seconds));
  }
  return times;
}

}  // namespace

Trajectory read_trajectory(const std::string& file, const std::string& times_file) {
  const std::vector<Line> lines = detail::read_lines(file);
  Trajectory trajectory;
  trajectory.reserve(lines.size());
  const bool csv = lines.front().text.find(',') != std::string::npos;
  const bool kitti = !csv && fields(lines.front().text, false).size() == 12;
  if (!kitti && !times_file.empty())
    throw error_at(file, 0, "", "a file of times belongs to KITTI poses (12 fields a line), this is not one");
  if (kitti) {
    if (times_file.empty()) throw error_at(file, 0, "", "KITTI poses need a file of times (--times)");
    const std::vector<std::int64_t> times = read_times(times_file);
    if (times.size() != lines.size())
      throw error_at(times_file, 0, "",
                     "expected " + std::to_string(lines.size()) + " times, one for each pose of " + file +
                         ", got " + std::to_string(times.size()));
    for (std::size_t i = 0; i < lines.size(); ++i)
      trajectory.push_back({times[i], kitti_line(file, lines[i])});
  } else {
    for (const Line& line : lines) trajectory.push_back(csv ? euroc_line(file, line) : tum_line(file, line));
  }
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    if (trajectory[i].time_us <= trajectory[i - 1].time_us)
      throw error_at(file, lines[i].number, "time", "does not increase (times must, line by line)");
  return trajectory;
}

void write_tum(const std::string& file, const Trajectory& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  char line[256];
  for (const StampedPose& stamped : trajectory) {
    const Pose pose = to_pose(stamped.pose);
    const Eigen::Vector3d& t = pose.translation;
    const Eigen::Quaterniond& q = pose.rotation;
    const std::int64_t magnitude = std::abs(stamped.time_us);
    std::snprintf(line, sizeof line, "%s%lld.%06lld %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n",
                  stamped.time_us < 0 ? "-" : "", static_cast<long long>(magnitude / 1'000'000),
                  static_cast<long long>(magnitude % 1'000'000), t.x(), t.y(), t.z(), q.x(), q.y(), q.z(),
                  q.w());
    text += line;
  }
  write_whole_file(file, text);
}

}  // namespace egocal
