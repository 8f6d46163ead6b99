// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace egocal::detail {

/// What is measured by a column.
enum class Dimension { time, length, angle, speed, turning, number };

/// The unit in s, m, rad, m/s or rad/s; nothing where it is not known. unit: without blanks, in small
/// letters.
std::optional<double> in_si(Dimension dimension, std::string_view unit);

/// The units of this dimension by their usual names, as "m, cm, mm".
std::string known_units(Dimension dimension);

/// The last word of a column's name such as "x_mm" that is a unit: only words that mean nothing else
/// there ("x_min" is the least x).
bool is_unit_word(std::string_view word);

/// Whether the text in the place of the unit names a clock or a format of times instead of a unit, as in
/// "time (UTC)" and "time (YYYY-MM-DD hh:mm:ss)".
bool states_a_clock(std::string_view unit);

}  // namespace egocal::detail
