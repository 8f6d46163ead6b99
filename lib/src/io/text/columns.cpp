// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/columns.hpp"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <optional>

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

/// A column's name in lower-case words, and its unit.
struct ColumnName {
  std::vector<std::string> words;
  std::string joined;        ///< all words in one
  std::string unit;          ///< "Yaw (deg)"
  std::optional<int> index;  ///< "q[0]"

  bool any_of(Words list) const {
    return std::any_of(words.begin(), words.end(), [&](const std::string& w) { return is_one_of(w, list); });
  }
};

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
      if (c != ' ') unit += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (unit.size() == 1 && unit[0] >= '0' && unit[0] <= '9')
      name.index = unit[0] - '0';
    else if (!unit.empty() && !is_known_unit(name.unit))
      name.unit = unit;
    text.remove_prefix(end);
  }
}

ColumnName parse(std::string_view text) {
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
    const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
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

struct Meaning {
  Quantity quantity{};
  int rank = 0;  ///< the more specific name is taken; 0: not understood
};

bool ends_with(std::string_view word, std::string_view end) {
  return word.size() >= end.size() && word.substr(word.size() - end.size()) == end;
}

bool ends_with_any(std::string_view word, Words ends) {
  return std::any_of(ends.begin(), ends.end(), [&](std::string_view end) { return ends_with(word, end); });
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

Meaning meaning_of_time(const ColumnName& name) {
  const std::string_view last = name.words.back();
  if (is_one_of(last, {"nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds"}))
    return {Quantity::nanoseconds, 1};
  if (is_one_of(last, {"sec", "secs", "seconds"})) return {Quantity::seconds, 1};
  // "header.stamp", "ImageTimestamp", "GPSTime": words may be written together
  if (ends_with(last, "stamp") || ends_with(last, "stamps")) return {Quantity::time, 3};
  if (is_one_of(name.joined, {"t", "times", "ts", "epoch", "timestampns", "timens"}) ||
      ends_with(last, "time"))
    return {Quantity::time, 2};
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
  const bool in_rotation = name.any_of({"q", "quat", "quaternion", "orientation", "rotation", "rot"});
  if (rotation || (stem.empty() && (in_rotation || (index == 0 && name.words.size() == 1))))
    return {rotations[index], 2};
  if (index == 0 || in_rotation) return {};
  if (is_one_of(stem, {"p", "t", "pos", "position", "trans", "translation", "loc", "location"}))
    return {positions[index], 2};
  if (!stem.empty()) return {};
  const bool in_position = name.any_of({"p", "pos", "position", "translation", "trans", "t", "location"});
  return {positions[index], in_position ? 3 : 1};
}

/// "vx", "v", "linear.x", "twist.angular.z", "yaw_rate", ...
Meaning meaning_of_velocity(const ColumnName& name) {
  const std::string_view last = name.words.back();
  if (name.any_of(uncertainties) || name.any_of(accelerations)) return {};
  if (is_one_of(name.joined, {"v", "vel", "velocity", "speed"})) return {Quantity::vx, 1};
  if (is_one_of(name.joined, {"yawrate", "turnrate", "omega"})) return {Quantity::wz, 1};
  const char axis = last.back();
  if (axis < 'x' || axis > 'z') return {};
  constexpr Quantity linear[] = {Quantity::vx, Quantity::vy, Quantity::vz};
  constexpr Quantity angular[] = {Quantity::wx, Quantity::wy, Quantity::wz};
  const int index = axis - 'x';
  const std::string_view stem = last.substr(0, last.size() - 1);
  if (is_one_of(stem, {"v", "vel"}) ||
      (stem.empty() && name.words.size() > 1 && name.any_of({"v", "vel", "velocity", "linear"})))
    return {linear[index], 2};
  if (is_one_of(stem, {"w", "omega", "gyro"}) ||
      (stem.empty() && name.words.size() > 1 && name.any_of({"w", "omega", "gyro", "angular", "rate"})))
    return {angular[index], 2};
  return {};
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

ColumnMap::Column column_of(Quantity quantity, std::size_t index, const std::string& unit) {
  const Dimension dimension = dimension_of(quantity);
  ColumnMap::Column column{index, unit};
  if (dimension == Dimension::time && states_a_clock(unit)) column.unit.clear();
  column.in_si = in_si(dimension, column.unit);
  // "yaw_rate_deg"
  if (dimension == Dimension::turning && !column.in_si) column.in_si = in_si(Dimension::angle, column.unit);
  return column;
}

}  // namespace

std::string_view to_string(Quantity quantity) {
  constexpr std::string_view names[] = {
      "time", "seconds", "nanoseconds", "x",         "y",      "z",  "qw", "qx", "qy", "qz", "roll", "pitch",
      "yaw",  "heading", "latitude",    "longitude", "height", "vx", "vy", "vz", "wx", "wy", "wz"};
  return names[static_cast<std::size_t>(quantity)];
}

bool ColumnMap::has_position() const {
  return has(Quantity::x) && has(Quantity::y);
}

bool ColumnMap::has_quaternion() const {
  return has(Quantity::qw) && has(Quantity::qx) && has(Quantity::qy) && has(Quantity::qz);
}

std::string ColumnMap::missing() const {
  std::string text;
  if (has_twist()) return "no time";
  if (!has_position() && !has_geodetic()) text = "no position (x y z, or latitude longitude height)";
  if (!has_attitude())
    text +=
        std::string(text.empty() ? "" : ", ") + "no orientation (qw qx qy qz, roll pitch yaw, or yaw alone)";
  return text;
}

std::size_t ColumnMap::width() const {
  std::size_t width = 0;
  for (const auto& column : of)
    if (column) width = std::max(width, column->index + 1);
  return width;
}

Dimension dimension_of(Quantity quantity) {
  if (quantity <= Quantity::nanoseconds) return Dimension::time;
  if (quantity <= Quantity::z || quantity == Quantity::height) return Dimension::length;
  if (quantity <= Quantity::qz) return Dimension::number;
  if (quantity <= Quantity::longitude) return Dimension::angle;
  return quantity <= Quantity::vz ? Dimension::speed : Dimension::turning;
}

bool same_name(std::string_view one, std::string_view other) {
  const ColumnName a = parse(one), b = parse(other);
  return a.words == b.words && a.index == b.index && a.unit == b.unit;
}

ColumnMap columns_from_names(const std::vector<std::string_view>& names) {
  ColumnMap map;
  std::array<int, quantities> rank{};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const ColumnName parsed = parse(names[i]);
    const Meaning meaning = meaning_of(parsed);
    if (meaning.rank == 0) continue;
    int& best = rank[static_cast<std::size_t>(meaning.quantity)];
    std::optional<ColumnMap::Column>& column = map.of[static_cast<std::size_t>(meaning.quantity)];
    if (meaning.rank == best && !column->rival) column->rival = i;
    if (meaning.rank <= best) continue;
    best = meaning.rank;
    column = column_of(meaning.quantity, i, parsed.unit);
  }
  // poses are better than velocities, which are integrated
  if (map.has_pose())
    for (const Quantity quantity :
         {Quantity::vx, Quantity::vy, Quantity::vz, Quantity::wx, Quantity::wy, Quantity::wz})
      map.of[static_cast<std::size_t>(quantity)].reset();
  // what is given twice is read from the one that needs no conversion
  if (map.has_quaternion())
    for (const Quantity quantity : {Quantity::roll, Quantity::pitch, Quantity::yaw, Quantity::heading})
      map.of[static_cast<std::size_t>(quantity)].reset();
  if (map.has_position())
    for (const Quantity quantity : {Quantity::latitude, Quantity::longitude})
      map.of[static_cast<std::size_t>(quantity)].reset();
  // "easting, northing, altitude"
  if (map.has(Quantity::x) && map.has(Quantity::y) && !map.has(Quantity::z) && map.has(Quantity::height))
    map.of[static_cast<std::size_t>(Quantity::z)] = map[Quantity::height];
  // one column of seconds or nanoseconds alone is the time
  const bool seconds = map.has(Quantity::seconds), rest = map.has(Quantity::nanoseconds);
  if (seconds != rest && !map.has(Quantity::time)) {
    const ColumnMap::Column& only = map[seconds ? Quantity::seconds : Quantity::nanoseconds];
    const std::string unit = !only.unit.empty() ? only.unit : seconds ? "s" : "ns";
    map.of[static_cast<std::size_t>(Quantity::time)] = column_of(Quantity::time, only.index, unit);
  }
  if (seconds != rest || map.has(Quantity::time)) {
    map.of[static_cast<std::size_t>(Quantity::seconds)].reset();
    map.of[static_cast<std::size_t>(Quantity::nanoseconds)].reset();
  }
  return map;
}

}  // namespace egocal::detail
