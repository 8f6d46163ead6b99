// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "offline/calibration.hpp"

namespace egocal::tools {

/// Solves still poses that were read as trajectories. Throws Error naming the files.
void answer_samples(const SolveRequest& request, const Trajectory& a, const Trajectory& b,
                    SolveResult& result);

/// Target, its spread and the residual of each sample, of a result with samples.
nlohmann::ordered_json samples_json(const SolveResult& result);
std::string samples_text(const SolveResult& result);

}  // namespace egocal::tools
