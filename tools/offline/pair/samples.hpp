// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "offline/pair/calibration.hpp"

namespace egocal::tools {

/// Solves still poses that were read as trajectories. Throws Error naming the files.
void answer_samples(const SolveRequest& request, const Trajectory& a, const Trajectory& b,
                    SolveResult& result);

}  // namespace egocal::tools
