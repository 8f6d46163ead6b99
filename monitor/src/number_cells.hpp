// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Numbers in a fixed number of cells. They lose decimals there, which can be missed, never their first or
// last figures, nor their unit.
#pragma once

#include <array>
#include <cstdio>
#include <string>

#include "answer_text.hpp"

namespace egocal::monitor {

inline std::string power_of_ten(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.0e", value);
  return text.data();
}

/// A number with as many decimals as leave a blank before it, or as a power of ten.
inline std::string in_cells(double value, int decimals, int cells, Charset charset) {
  for (int shown = decimals; shown >= 0; --shown)
    if (const std::string text = number(value, shown, charset); width_of(text) < cells)
      return pad_left(text, cells);
  return pad_left(power_of_ten(value), cells);
}

/// The text of a distance [m] where it fits; else in whole centimetres, in metres, or as a power of ten.
/// before: what is not part of the number, such as the sign of a standard deviation.
inline std::string distance_in(int cells, std::string text, double metres, Charset charset,
                               const std::string& before = "") {
  const auto fits = [&] { return width_of(text) <= cells; };
  if (!fits()) text = before + number(metres * centimetres_per_metre, 0, charset) + " cm";
  for (int decimals = 1; decimals >= 0 && !fits(); --decimals)
    text = before + number(metres, decimals, charset) + " m";
  return fits() ? text : before + power_of_ten(metres) + " m";
}

}  // namespace egocal::monitor
