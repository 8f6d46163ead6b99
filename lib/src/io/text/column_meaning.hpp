// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/text/columns.hpp"

namespace egocal::detail {

/// A column's name in lower-case words, and its unit.
struct ColumnName {
  std::vector<std::string> words;
  std::string joined;        ///< all words in one
  std::string unit;          ///< "Yaw (deg)"
  std::optional<int> index;  ///< "q[0]"
};

ColumnName parse_column_name(std::string_view text);

/// What a name tells of its column.
struct Meaning {
  Quantity quantity{};
  int rank = 0;  ///< the more specific name is taken; 0: not understood
};

/// The rank of a time that a message's header holds, in one column.
inline constexpr int time_of_header = 5;

Meaning meaning_of(const ColumnName& name);

/// Whether phi and theta are roll and pitch: beside psi or a yaw. theta alone is a heading, and so is psi.
bool have_euler_letters(const std::vector<ColumnName>& names);

/// What a name means among such names.
Meaning meaning_among_euler_letters(const ColumnName& name);

}  // namespace egocal::detail
