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
/// "0.07 deg, 1.5 cm (0.3 % of the distance) a motion of 1.8 s; ..."; empty: there is none.
std::string fit_in_words(const Fit& fit);
/// "reached", or "missing: yaw; about 40 s more of this driving".
std::string goal_in_words(const Goal& goal);

}  // namespace egocal::tools
