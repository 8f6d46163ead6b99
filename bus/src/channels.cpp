// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/channels.hpp"

#include <string_view>

namespace egocal::bus {

std::string motion_channel(const std::string& a, const std::string& b) {
  return "EGOCAL_MOTION_" + a + "_" + b;
}

std::string problem_channel(const std::string& a, const std::string& b) {
  return "EGOCAL_PROBLEM_" + a + "_" + b;
}

std::string calibration_channel(const std::string& a, const std::string& b) {
  return "EGOCAL_CALIBRATION_" + a + "_" + b;
}

std::string escaped(const std::string& channel) {
  static constexpr std::string_view special = "\\^$.|?*+()[]{}";
  std::string pattern;
  for (const char c : channel) {
    if (special.find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

}  // namespace egocal::bus
