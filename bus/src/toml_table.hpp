// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <toml++/toml.h>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "egocal/limits.hpp"

namespace egocal::bus {

/// One table of a TOML file, with its name for messages. Each method throws Error with the line of what it
/// refuses. The parsed file and its name must outlive the object.
class TomlTable {
 public:
  TomlTable(const toml::table& table, std::string name, const std::string& file)
      : table_(table), name_(std::move(name)), file_(file) {}

  [[noreturn]] void fail(const toml::node* node, const std::string& key, const std::string& problem) const;
  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;

  /// Refuses other keys than these.
  void only(std::initializer_list<std::string_view> keys) const;
  bool has(const std::string& key) const;
  const toml::node& require(const std::string& key) const;
  bool is_text(const std::string& key) const { return require(key).is_string(); }

  std::string text(const std::string& key) const;
  /// One of these texts.
  std::string choice(const std::string& key, std::initializer_list<std::string_view> choices) const;
  double number(const std::string& key, const Range& range, const std::string& unit) const;
  /// This many numbers, none larger in magnitude than limits::largest_distance.
  std::vector<double> numbers(const std::string& key, std::size_t count, const std::string& meaning) const;
  /// [x, y, z, qw, qx, qy, qz], metres; the quaternion is normalised.
  Pose pose(const std::string& key) const;
  /// The same, or [x, y, z]; nan for what is not known (egocal/online/nominal_part.hpp).
  Pose nominal(const std::string& key) const;
  /// 1 to 40 letters, digits, _ and -.
  std::string sensor_name(const std::string& key) const;
  /// The tables of [[key]], one at least.
  std::vector<TomlTable> tables(const std::string& key) const;
  /// Empty: there is none.
  std::optional<TomlTable> table(const std::string& key) const;

 private:
  double number(const toml::node& node, const std::string& key, const Range& range,
                const std::string& unit) const;

  const toml::table& table_;
  std::string name_;
  const std::string& file_;
};

}  // namespace egocal::bus
