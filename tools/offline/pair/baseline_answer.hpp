// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/problem/cost.hpp"
#include "offline/pair/calibration.hpp"

namespace egocal::tools {

/// Puts the answer of one of the paper's baselines in the place of ours. They minimise other things: our
/// certificate shows what their answer is worth.
void answer_by_baseline(const std::string& method, const std::vector<MotionPair>& pairs, SolveResult& result);

}  // namespace egocal::tools
