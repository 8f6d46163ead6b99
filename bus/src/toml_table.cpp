// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "toml_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "egocal/bus/plausible.hpp"
#include "egocal/error.hpp"
#include "egocal/online/nominal_part.hpp"

namespace egocal::bus {

namespace {

/// "x, y" or "\"x\", \"y\"".
std::string listed(std::initializer_list<std::string_view> words, std::string_view quote) {
  std::string list;
  for (const std::string_view word : words)
    list.append(list.empty() ? "" : ", ").append(quote).append(word).append(quote);
  return list;
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

void TomlTable::fail(const toml::node* node, const std::string& key, const std::string& problem) const {
  const long line = static_cast<long>((node ? node->source() : table_.source()).begin.line);
  const std::string field = name_.empty() ? key : key.empty() ? name_ : name_ + "." + key;
  throw error_at(file_, line, field, problem);
}

void TomlTable::fail(const std::string& key, const std::string& problem) const {
  fail(table_.get(key), key, problem);
}

void TomlTable::only(std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, node] : table_) {
    if (is_one_of(key.str(), keys)) continue;
    const long line = static_cast<long>(key.source().begin.line);
    throw error_at(file_, line, (name_.empty() ? "" : name_ + ".") + printable(std::string(key.str()), 60),
                   "unknown key; expected one of: " + listed(keys, ""));
  }
}

bool TomlTable::has(const std::string& key) const {
  return table_.get(key) != nullptr;
}

const toml::node& TomlTable::require(const std::string& key) const {
  const toml::node* node = table_.get(key);
  if (!node) fail(key, "is missing");
  return *node;
}

std::string TomlTable::text(const std::string& key) const {
  const toml::node& node = require(key);
  if (!node.is_string()) fail(key, "expected a text in quotes");
  return node.as_string()->get();
}

std::string TomlTable::choice(const std::string& key, std::initializer_list<std::string_view> choices) const {
  std::string value = text(key);
  if (!is_one_of(value, choices))
    fail(key, "expected one of " + listed(choices, "\"") + ", got \"" + printable(value, 60) + "\"");
  return value;
}

double TomlTable::number(const toml::node& node, const std::string& key, const Range& range,
                         const std::string& unit) const {
  const std::optional<double> value = node.is_number() ? node.value<double>() : std::optional<double>{};
  if (!value || !range.contains(*value)) {
    std::ostringstream expected;
    expected << "expected a number from " << range.least << " to " << range.most << (unit.empty() ? "" : " ")
             << unit;
    fail(&node, key, expected.str());
  }
  return *value;
}

double TomlTable::number(const std::string& key, const Range& range, const std::string& unit) const {
  return number(require(key), key, range, unit);
}

std::vector<double> TomlTable::numbers(const std::string& key, std::size_t count,
                                       const std::string& meaning) const {
  const toml::node& node = require(key);
  const toml::array* array = node.as_array();
  if (!array || array->size() != count)
    fail(key, "expected " + std::to_string(count) + " numbers " + meaning);
  std::vector<double> values;
  for (const toml::node& element : *array)
    values.push_back(number(element, key, {-limits::largest_distance, limits::largest_distance}, ""));
  return values;
}

Pose TomlTable::pose(const std::string& key) const {
  const std::vector<double> v = numbers(key, 7, "[x, y, z, qw, qx, qy, qz]");
  Pose pose{{v[3], v[4], v[5], v[6]}, {v[0], v[1], v[2]}};
  if (!plausible_norm(pose.rotation.norm()))
    fail(key, "the quaternion (qw, qx, qy, qz) is not of unit length");
  pose.rotation.normalize();
  return pose;
}

Pose TomlTable::nominal(const std::string& key) const {
  const std::string meaning = "[x, y, z, qw, qx, qy, qz] or [x, y, z], nan for what is not known";
  const toml::array* array = require(key).as_array();
  if (!array || (array->size() != 3 && array->size() != 7)) fail(key, "expected " + meaning);
  std::array<double, 7> v{};
  v.fill(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::node& element = *array->get(i);
    const std::optional<double> value = element.value<double>();
    if (!element.is_number() || !value || !std::isnan(*value))
      v[i] = number(element, key, {-limits::largest_distance, limits::largest_distance}, "or nan");
  }
  Pose pose{{v[3], v[4], v[5], v[6]}, {v[0], v[1], v[2]}};
  if (const std::string wrong = wrong_with_part(pose); !wrong.empty()) fail(key, wrong);
  if (!pose.rotation.coeffs().allFinite()) return pose;
  if (!plausible_norm(pose.rotation.norm()))
    fail(key, "the quaternion (qw, qx, qy, qz) is not of unit length");
  pose.rotation.normalize();
  return pose;
}

std::string TomlTable::sensor_name(const std::string& key) const {
  std::string value = text(key);
  if (!plausible_name(value)) fail(key, "expected 1 to 40 letters, digits, _ or -");
  return value;
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) const {
  const toml::array* array = require(key).as_array();
  if (!array || array->empty()) fail(key, "expected [[" + key + "]] sections");
  std::vector<TomlTable> tables;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::table* table = array->get(i)->as_table();
    if (!table) fail(array->get(i), key, "expected [[" + key + "]] sections");
    tables.emplace_back(*table, key + "[" + std::to_string(i + 1) + "]", file_);
  }
  return tables;
}

std::optional<TomlTable> TomlTable::table(const std::string& key) const {
  const toml::node* node = table_.get(key);
  if (!node) return std::nullopt;
  if (!node->is_table()) fail(key, "expected a table");
  return TomlTable(*node->as_table(), name_.empty() ? key : name_ + "." + key, file_);
}

}  // namespace egocal::bus
