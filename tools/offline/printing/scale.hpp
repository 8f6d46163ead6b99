// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "offline/pair/calibration.hpp"

namespace egocal::tools {

/// The scale that was found or given, and how it changes along the drive. The JSON needs a scale that was
/// found.
nlohmann::ordered_json scale_json(const SolveResult& result);
/// How the scale changes along the drive, a line a segment; empty where it does not.
std::string scale_course_text(const SolveResult& result);
/// The scale for people; empty where lengths are as they were read.
std::string scale_text(const SolveResult& result);

}  // namespace egocal::tools
