// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The parts of a diagnosis as machine-readable output, the same in every tool and in the monitor.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "egocal/diagnosis/verdict.hpp"

namespace egocal::bus {

/// rotation_deg_median, rotation_deg_95, translation_m_median, translation_m_95, translation_relative_median,
/// length_ratio, turning_ratio, motion_seconds, and tenths where there are any.
nlohmann::ordered_json fit_json(const Fit& fit);
/// A list of {code, certain, message, remedy, improvement, value?, time?, translation?, rotation_wxyz?}.
nlohmann::ordered_json findings_json(const std::vector<Finding>& findings);
/// reached, missing, seconds_left (or null), next.
nlohmann::ordered_json goal_json(const Goal& goal);

}  // namespace egocal::bus
