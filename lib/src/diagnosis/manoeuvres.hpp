// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// In a driver's words, the manoeuvre of the platform's catalogue after which the missing directions (0 to 5:
/// x y z roll pitch yaw) would be known best: the information of each is added to that of the drive.
std::string next_manoeuvre(const Answered& answered, const GoalOptions& options,
                           const std::vector<std::size_t>& missing);

}  // namespace egocal::detail
