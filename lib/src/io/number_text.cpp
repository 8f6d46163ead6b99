// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/number_text.hpp"

#include <charconv>

namespace egocal::detail {

void append_number(std::string& text, double value) {
  char buffer[32];  // a double needs 24 at most
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

void append_seconds(std::string& text, std::int64_t time_us) {
  constexpr std::uint64_t second_us = 1'000'000;  // unit
  if (time_us < 0) text += '-';
  const std::uint64_t magnitude =
      time_us < 0 ? 0 - static_cast<std::uint64_t>(time_us) : static_cast<std::uint64_t>(time_us);
  text += std::to_string(magnitude / second_us) + '.';
  text += std::to_string(second_us + magnitude % second_us).substr(1);
}

}  // namespace egocal::detail
