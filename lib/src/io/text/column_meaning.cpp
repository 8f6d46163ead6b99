// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/column_meaning.hpp"
#include "io/text.hpp"

#include <algorithm>
#include <initializer_list>
#include <iterator>

namespace egocal::detail {

namespace {

using Words = std::initializer_list<std::string_view>;

const Words rates = {"vel", "velocity", "rate"};
const Words accelerations = {"acc", "accel", "acceleration"};
const Words uncertainties = {"covariance", "cov", "std",  "sigma", "stddev",
                             "sd",         "b",   "bias", "var",   "error"};

bool is_one_of(std::string_view word, Words words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool any_of(const ColumnName& name, Words list) {
  return std::any_of(name.words.begin(), name.words.end(),
                     [&](const std::string& word) { return is_one_of(word, list); });
}

bool is_known_unit(std::string_view unit) {
  constexpr Dimension all[] = {Dimension::time,  Dimension::length,  Dimension::angle,
                               Dimension::speed, Dimension::turning, Dimension::number};
  return std::any_of(std::begin(all), std::end(all),
                     [&](Dimension dimension) { return in_si(dimension, unit).has_value(); });
}

/// "[0]", "[m]", "(map) [m]": an index, and the unit that is known, else the last of the others.
void read_brackets(std::string_view text, ColumnName& name) {
  while (true) {
    const std::size_t begin = text.find_first_of("[(");
    if (begin == std::string_view::npos) return;
    const std::size_t end = std::min(text.find_first_of("])", begin), text.size());
    std::string unit;
    for (const char c : text.substr(begin + 1, end - begin - 1))
      if (c != ' ') unit += lower_case(c);
    if (unit.size() == 1 && unit[0] >= '0' && unit[0] <= '9')
      name.index = unit[0] - '0';
    else if (!unit.empty() && !is_known_unit(name.unit))
      name.unit = unit;
    text.remove_prefix(end);
  }
}

bool ends_with_any(std::string_view word, Words ends) {
  return std::any_of(ends.begin(), ends.end(), [&](std::string_view end) { return word.ends_with(end); });
}

/// Velocities, rates, biases and uncertainties are named like poses; words may be written together
/// ("angvel_z").
bool is_no_pose(std::string_view word) {
  return is_one_of(word, {"v", "linear", "angular", "twist", "gyro"}) || is_one_of(word, uncertainties) ||
         ends_with_any(word, rates) || ends_with_any(word, accelerations);
}

/// Elements of an array: "q[0]" is w, as PX4 and Eigen's constructors order them; "position[0]" is x.
Meaning meaning_of_element(const ColumnName& name) {
  const std::string_view last = name.words.back();
  const int index = *name.index;
  constexpr Quantity rotations[] = {Quantity::qw, Quantity::qx, Quantity::qy, Quantity::qz};
  constexpr Quantity positions[] = {Quantity::x, Quantity::y, Quantity::z};
  if (index < 4 && is_one_of(last, {"q", "quat", "quaternion"})) return {rotations[index], 2};
  if (index < 3 && is_one_of(last, {"p", "pos", "position", "translation"})) return {positions[index], 2};
  return {};
}

/// A bag as csv has two times: that of the measurement, in the header, and that of recording.
Meaning meaning_of_time(const ColumnName& name) {
  const std::string_view last = name.words.back();
  const bool header = any_of(name, {"header"});
  const bool stamp = header || any_of(name, {"stamp"});
  if (is_one_of(last, {"nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds"}))
    return {Quantity::nanoseconds, header ? 3 : stamp ? 2 : 1};
  if (is_one_of(last, {"sec", "secs", "seconds"})) return {Quantity::seconds, header ? 3 : stamp ? 2 : 1};
  const bool of_recording = std::any_of(name.words.begin(), name.words.end(), [](std::string_view word) {
    for (const std::string_view begin : {"rosbag", "bag", "recv", "receiv", "record", "arriv", "log"})
      if (word.starts_with(begin)) return true;
    return false;
  });
  // "header.stamp", "ImageTimestamp", "GPSTime": words may be written together
  if (last.ends_with("stamp") || last.ends_with("stamps"))
    return {Quantity::time, header ? time_of_header : of_recording ? 1 : 4};
  if (is_one_of(name.joined, {"t", "times", "ts", "epoch", "timestampns", "timens", "time"}))
    return {Quantity::time, 3};
  if (last.ends_with("time")) return {Quantity::time, of_recording ? 1 : 2};
  return {};
}

Meaning meaning_of_axis(const ColumnName& name) {
  const std::string_view last = name.words.back();
  const char axis = last.back();
  if (!is_one_of(std::string_view(&axis, 1), {"w", "x", "y", "z"})) return {};
  const int index = axis == 'w' ? 0 : 1 + (axis - 'x');
  const std::string_view stem = last.substr(0, last.size() - 1);
  constexpr Quantity rotations[] = {Quantity::qw, Quantity::qx, Quantity::qy, Quantity::qz};
  constexpr Quantity positions[] = {Quantity::time, Quantity::x, Quantity::y, Quantity::z};
  const bool rotation = is_one_of(stem, {"q", "quat", "quaternion", "orientation", "rotation", "rot"});
  const bool in_rotation = any_of(name, {"q", "quat", "quaternion", "orientation", "rotation", "rot"});
  if (rotation || (stem.empty() && (in_rotation || (index == 0 && name.words.size() == 1))))
    return {rotations[index], 2};
  if (index == 0 || in_rotation) return {};
  if (is_one_of(stem, {"p", "t", "pos", "position", "trans", "translation", "loc", "location"}))
    return {positions[index], 2};
  if (!stem.empty()) return {};
  const bool in_position = any_of(name, {"p", "pos", "position", "translation", "trans", "t", "location"});
  return {positions[index], in_position ? 3 : 1};
}

/// "vx", "v", "linear.x", "twist.angular.z", "yaw_rate", ...
Meaning meaning_of_velocity(const ColumnName& name) {
  const std::string_view last = name.words.back();
  if (any_of(name, uncertainties) || any_of(name, accelerations)) return {};
  if (is_one_of(name.joined, {"v", "vel", "velocity", "speed"})) return {Quantity::vx, 1};
  if (is_one_of(name.joined, {"yawrate", "turnrate", "omega"})) return {Quantity::wz, 1};
  const char axis = last.back();
  if (axis < 'x' || axis > 'z') return {};
  constexpr Quantity linear[] = {Quantity::vx, Quantity::vy, Quantity::vz};
  constexpr Quantity angular[] = {Quantity::wx, Quantity::wy, Quantity::wz};
  const int index = axis - 'x';
  const std::string_view stem = last.substr(0, last.size() - 1);
  if (is_one_of(stem, {"v", "vel"}) ||
      (stem.empty() && name.words.size() > 1 && any_of(name, {"v", "vel", "velocity", "linear"})))
    return {linear[index], 2};
  if (is_one_of(stem, {"w", "omega", "gyro"}) ||
      (stem.empty() && name.words.size() > 1 && any_of(name, {"w", "omega", "gyro", "angular", "rate"})))
    return {angular[index], 2};
  return {};
}

/// Whether it is this Greek letter of an angle, and no rate, bias or standard deviation of it.
bool is_angle_called(const ColumnName& name, std::string_view letter) {
  return !name.index && !name.words.empty() && name.words.back() == letter &&
         std::none_of(name.words.begin(), name.words.end(), is_no_pose);
}

}  // namespace

ColumnName parse_column_name(std::string_view text) {
  ColumnName name;
  const std::size_t bracket = std::min(text.find_first_of("[("), text.size());
  read_brackets(text.substr(bracket), name);
  text = text.substr(0, bracket);
  std::string word;
  const auto finish = [&] {
    if (!word.empty()) name.words.push_back(word);
    word.clear();
  };
  for (const char c : text) {
    const char lower = lower_case(c);
    if ((lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9'))
      word += lower;
    else
      finish();
  }
  finish();
  if (name.unit.empty() && name.words.size() > 1 && is_unit_word(name.words.back())) {
    name.unit = name.words.back();
    name.words.pop_back();
    // "wz_rad_s"
    const std::string per_second = name.words.back() + "/s";
    if (name.unit == "s" && name.words.size() > 1 &&
        (in_si(Dimension::speed, per_second) || in_si(Dimension::turning, per_second))) {
      name.unit = per_second;
      name.words.pop_back();
    }
  }
  for (const std::string& w : name.words) name.joined += w;
  return name;
}

Meaning meaning_of(const ColumnName& name) {
  if (name.words.empty()) return {};
  if (name.index) return meaning_of_element(name);
  if (const Meaning velocity = meaning_of_velocity(name); velocity.rank > 0) return velocity;
  if (name.words.size() > 1 && std::any_of(name.words.begin(), name.words.end(), is_no_pose)) return {};
  const std::string_view last = name.words.back();
  if (is_one_of(last, {"lat", "latitude"})) return {Quantity::latitude, 2};
  if (is_one_of(last, {"lon", "long", "lng", "longitude"})) return {Quantity::longitude, 2};
  if (is_one_of(last, {"alt", "altitude", "height", "elevation"})) return {Quantity::height, 2};
  if (is_one_of(last, {"easting", "east"})) return {Quantity::x, 1};
  if (is_one_of(last, {"northing", "north"})) return {Quantity::y, 1};
  if (is_one_of(last, {"up"})) return {Quantity::z, 1};
  if (last == "roll") return {Quantity::roll, 2};
  if (last == "pitch") return {Quantity::pitch, 2};
  if (is_one_of(last, {"yaw", "theta", "psi"})) return {Quantity::yaw, 2};
  if (is_one_of(last, {"heading", "azimuth"})) return {Quantity::heading, 2};
  if (const Meaning axis = meaning_of_axis(name); axis.rank > 0) return axis;
  return meaning_of_time(name);
}

bool have_euler_letters(const std::vector<ColumnName>& names) {
  const auto has = [&](std::string_view letter) {
    return std::any_of(names.begin(), names.end(),
                       [&](const ColumnName& name) { return is_angle_called(name, letter); });
  };
  return (has("psi") || has("yaw")) && (has("phi") || has("theta"));
}

Meaning meaning_among_euler_letters(const ColumnName& name) {
  if (is_angle_called(name, "phi")) return {Quantity::roll, 2};
  if (is_angle_called(name, "theta")) return {Quantity::pitch, 2};
  return meaning_of(name);
}

}  // namespace egocal::detail
