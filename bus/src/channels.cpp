// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/channels.hpp"

namespace egocal::bus {

std::string motion_channel(const std::string& a, const std::string& b) {
  return "EGOCAL_MOTION_" + a + "_" + b;
}

std::string problem_channel(const std::string& a, const std::string& b) {
  return problem_prefix + a + "_" + b;
}

std::string calibration_channel(const std::string& a, const std::string& b) {
  return calibration_prefix + a + "_" + b;
}

std::string verdict_channel(const std::string& a, const std::string& b) {
  return verdict_prefix + a + "_" + b;
}

std::string scale_problem_channel(const std::string& a, const std::string& b) {
  return scale_problem_prefix + a + "_" + b;
}

std::string scale_channel(const std::string& a, const std::string& b) {
  return scale_prefix + a + "_" + b;
}

}  // namespace egocal::bus
