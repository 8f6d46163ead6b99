// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Verdicts, platforms and goals as words.
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "egocal/degrees.hpp"
#include "egocal/diagnosis/options.hpp"
#include "egocal/diagnosis/verdict.hpp"

namespace egocal {

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::good:
      return "good";
    case Verdict::incomplete:
      return "incomplete";
    case Verdict::doubtful:
      return "doubtful";
    case Verdict::contradictory:
      return "contradictory";
  }
  return "unknown";
}

std::string_view to_string(Platform platform) {
  switch (platform) {
    case Platform::car:
      return "car";
    case Platform::handheld:
      return "handheld";
    case Platform::drone:
      return "drone";
    case Platform::arm:
      return "arm";
  }
  return "unknown";
}

std::optional<Platform> platform_from_name(std::string_view text) {
  for (const Platform platform : {Platform::car, Platform::handheld, Platform::drone, Platform::arm})
    if (to_string(platform) == text) return platform;
  return std::nullopt;
}

namespace {

/// A number above 0 with one of these units.
std::optional<double> quantity(std::string_view text,
                               std::initializer_list<std::pair<std::string_view, double>> units) {
  const auto trim = [](std::string_view part) {
    const std::size_t first = part.find_first_not_of(' ');
    return first == std::string_view::npos ? std::string_view()
                                           : part.substr(first, part.find_last_not_of(' ') + 1 - first);
  };
  text = trim(text);
  for (const auto& [unit, factor] : units) {
    if (!text.ends_with(unit)) continue;
    const std::string_view digits = trim(text.substr(0, text.size() - unit.size()));
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc{} && end == digits.data() + digits.size() && std::isfinite(value) && value > 0)
      return factor * value;
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<GoalOptions> goal_from_text(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const std::optional<double> rotation =
      quantity(text.substr(0, comma), {{"deg", radians_per_degree}, {"rad", 1}});
  const std::optional<double> translation =
      quantity(text.substr(comma + 1), {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}});
  if (!rotation || !translation) return std::nullopt;
  return GoalOptions{*rotation, *translation, std::nullopt};
}

}  // namespace egocal
