// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "offline/rig/calibration.hpp"

namespace egocal::tools {

bool is_open(const Loop& loop);

/// Why a pair should not be used, one sentence (RigReport::unusable): a finding that makes it bad, its own
/// verdict, or a loop that does not close. bad: the findings that make some pair of the rig bad. Needs the
/// sensor to blame.
std::string why_unusable(const RigReport& report, const std::vector<RigFinding>& bad, std::size_t pair);

}  // namespace egocal::tools
