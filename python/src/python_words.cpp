// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "python_words.hpp"

#include <cctype>
#include <string_view>
#include <utility>

namespace egocal::python {

namespace {

/// Longer ones before those that they begin with.
constexpr std::pair<std::string_view, std::string_view> words[] = {
    {"--time-offset auto", "time_offset='auto'"},
    {"--time-offset SECONDS", "time_offset"},
    {"--time-offset", "time_offset"},
    {"--weights auto", "weights='auto'"},
    {"--weights equal", "weights='equal'"},
    {"--weights", "weights"},
    {"--max-gap SECONDS", "max_gap"},
    {"--max-gap", "max_gap"},
    {"--plane-a", "plane_a"},
    {"--plane-b", "plane_b"},
    {"--nominal", "nominal"},
    {"--stride", "stride"},
    {"--method", "method"},
};

}  // namespace

std::string in_python_words(std::string text) {
  for (const auto& [option, argument] : words)
    for (std::size_t at = text.find(option); at != std::string::npos; at = text.find(option, at + 1)) {
      const std::size_t end = at + option.size();
      const auto next = end < text.size() ? static_cast<unsigned char>(text[end]) : 0;
      if (std::isalnum(next) == 0 && next != '-') text.replace(at, option.size(), argument);
    }
  return text;
}

}  // namespace egocal::python
