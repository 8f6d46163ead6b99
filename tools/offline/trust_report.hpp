// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "egocal/calibrate.hpp"

namespace egocal::tools {

/// verdict, reason, fit, findings and goal: what comes before every number.
nlohmann::ordered_json trust_json(const Calibration& calibration);
std::string trust_text(const Calibration& calibration);

}  // namespace egocal::tools
