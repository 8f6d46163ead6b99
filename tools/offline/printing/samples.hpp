// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "offline/pair/calibration.hpp"

namespace egocal::tools {

/// Target, its spread and the residual of each sample, of a result with samples.
nlohmann::ordered_json samples_json(const SolveResult& result);
std::string samples_text(const SolveResult& result);

}  // namespace egocal::tools
