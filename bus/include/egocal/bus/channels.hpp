// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::bus {

inline const std::string status_channel = "EGOCAL_STATUS";
inline const std::string command_channel = "EGOCAL_COMMAND";

inline const std::string problem_prefix = "EGOCAL_PROBLEM_";
inline const std::string calibration_prefix = "EGOCAL_CALIBRATION_";
inline const std::string verdict_prefix = "EGOCAL_VERDICT_";
inline const std::string scale_problem_prefix = "EGOCAL_SCALING_";
inline const std::string scale_prefix = "EGOCAL_SCALE_";

// Per pair: T is the pose of sensor b in sensor a.
std::string motion_channel(const std::string& a, const std::string& b);
std::string problem_channel(const std::string& a, const std::string& b);
std::string calibration_channel(const std::string& a, const std::string& b);
std::string verdict_channel(const std::string& a, const std::string& b);
std::string scale_problem_channel(const std::string& a, const std::string& b);
std::string scale_channel(const std::string& a, const std::string& b);

}  // namespace egocal::bus
