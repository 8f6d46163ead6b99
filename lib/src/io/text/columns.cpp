// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/columns.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "io/text/column_meaning.hpp"

namespace egocal::detail {

namespace {

ColumnMap::Column column_of(Quantity quantity, std::size_t index, const std::string& unit) {
  const Dimension dimension = dimension_of(quantity);
  ColumnMap::Column column{index, unit};
  if (dimension == Dimension::time && states_a_clock(unit)) column.unit.clear();
  column.in_si = in_si(dimension, column.unit);
  // "yaw_rate_deg"
  if (dimension == Dimension::turning && !column.in_si) column.in_si = in_si(Dimension::angle, column.unit);
  return column;
}

struct Candidate {
  std::size_t index = 0;
  int rank = 0;
  const ColumnName* name = nullptr;
};
using Candidates = std::array<std::vector<Candidate>, quantities>;

const std::vector<Candidate>& of(const Candidates& all, Quantity quantity) {
  return all[static_cast<std::size_t>(quantity)];
}

/// Words that two names begin with: "car.pose.x" and "car.pose.qx" are of one thing.
std::size_t agreement(const ColumnName& one, const ColumnName& other) {
  const auto end = std::mismatch(one.words.begin(), one.words.end(), other.words.begin(), other.words.end());
  return static_cast<std::size_t>(end.first - one.words.begin());
}

/// The best candidate: the largest rank, then the best agreement with the name `with`, then the first.
/// agreement_first: agreement counts more than rank.
const Candidate* best_of(const std::vector<Candidate>& candidates, const ColumnName* with,
                         bool agreement_first) {
  const Candidate* best = nullptr;
  std::pair<std::size_t, std::size_t> most;
  for (const Candidate& candidate : candidates) {
    std::pair<std::size_t, std::size_t> value{with ? agreement(*candidate.name, *with) : 0,
                                              static_cast<std::size_t>(candidate.rank)};
    if (!agreement_first) std::swap(value.first, value.second);
    if (best && value <= most) continue;
    best = &candidate;
    most = value;
  }
  return best;
}

/// Position and orientation of one object, if the names tell: chosen by the orientation first, or by the
/// position if no position goes with that.
struct Chosen {
  std::array<const Candidate*, quantities> of{};

  const Candidate*& operator[](Quantity quantity) { return of[static_cast<std::size_t>(quantity)]; }
  const ColumnName* name(Quantity quantity) { return (*this)[quantity] ? (*this)[quantity]->name : nullptr; }
};

Chosen choose(const Candidates& all) {
  using enum Quantity;
  constexpr Quantity positions[] = {x, y, z}, orientations[] = {qw, qx, qy, qz, roll, pitch, yaw, heading},
                     times[] = {time, seconds, nanoseconds};
  Chosen chosen;
  for (std::size_t i = 0; i < quantities; ++i) chosen.of[i] = best_of(all[i], nullptr, false);
  const ColumnName* orientation = nullptr;
  for (const Quantity quantity : {qx, yaw, heading})
    if (!orientation) orientation = chosen.name(quantity);
  if (!orientation || !chosen[x]) return chosen;
  for (const Quantity quantity : positions) chosen[quantity] = best_of(of(all, quantity), orientation, true);
  const ColumnName* const position = chosen.name(x);
  for (const Quantity quantity : orientations) chosen[quantity] = best_of(of(all, quantity), position, true);
  for (const Quantity quantity : times) chosen[quantity] = best_of(of(all, quantity), position, false);
  return chosen;
}

/// A later column that may be the same quantity: of the same rank, and of one thing with the orientation as
/// well as the one that is taken, or with another orientation.
std::optional<std::size_t> rival_of(const Candidates& all, Chosen& chosen, Quantity quantity) {
  const Candidate& taken = *chosen[quantity];
  const ColumnName* orientation = nullptr;
  bool another = false;
  for (const Quantity with : {Quantity::qx, Quantity::yaw, Quantity::heading}) {
    if (!orientation) orientation = chosen.name(with);
    another = another || of(all, with).size() > 1;
  }
  const bool position = quantity >= Quantity::x && quantity <= Quantity::z;
  for (const Candidate& other : of(all, quantity)) {
    if (&other == &taken || other.rank != taken.rank) continue;
    if (!position || another || !orientation ||
        agreement(*other.name, *orientation) == agreement(*taken.name, *orientation))
      return other.index;
  }
  return std::nullopt;
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
  const ColumnName a = parse_column_name(one), b = parse_column_name(other);
  return a.words == b.words && a.index == b.index && a.unit == b.unit;
}

ColumnMap columns_from_names(const std::vector<std::string_view>& names) {
  std::vector<ColumnName> parsed;
  parsed.reserve(names.size());
  for (const std::string_view name : names) parsed.push_back(parse_column_name(name));
  Candidates all;
  const bool letters = have_euler_letters(parsed);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const Meaning meaning = letters ? meaning_among_euler_letters(parsed[i]) : meaning_of(parsed[i]);
        meaning.rank > 0)
      all[static_cast<std::size_t>(meaning.quantity)].push_back({i, meaning.rank, &parsed[i]});
  Chosen chosen = choose(all);
  ColumnMap map;
  for (std::size_t i = 0; i < quantities; ++i) {
    if (!chosen.of[i]) continue;
    const auto quantity = static_cast<Quantity>(i);
    map.of[i] = column_of(quantity, chosen.of[i]->index, chosen.of[i]->name->unit);
    map.of[i]->rival = rival_of(all, chosen, quantity);
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
  // both together are what a header holds; a time beside them is that of recording
  const std::vector<Candidate>& times = of(all, Quantity::time);
  const bool of_header = chosen[Quantity::time] && chosen[Quantity::time]->rank == time_of_header;
  if (seconds && rest && !of_header) {
    const auto least = std::min_element(
        times.begin(), times.end(), [](const Candidate& a, const Candidate& b) { return a.rank < b.rank; });
    if (least != times.end()) map.other_time = least->index;
    map.of[static_cast<std::size_t>(Quantity::time)].reset();
    return map;
  }
  if (of_header)
    for (const Candidate& time : times)
      if (time.rank != time_of_header && !map.other_time) map.other_time = time.index;
  map.of[static_cast<std::size_t>(Quantity::seconds)].reset();
  map.of[static_cast<std::size_t>(Quantity::nanoseconds)].reset();
  return map;
}

}  // namespace egocal::detail
