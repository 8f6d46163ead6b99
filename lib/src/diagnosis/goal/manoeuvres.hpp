// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// A direction (0 to 5: x y z roll pitch yaw) whose standard deviation is this many times the wanted one;
/// infinite where the motions do not show it.
using Missing = std::pair<double, std::size_t>;

/// In a driver's words, the manoeuvre of the platform's catalogue after which the missing directions would be
/// known best: the information of each is added to that of the drive. Where none, repeated, would reach the
/// goal in half of seconds_left, the advice is to go on as before. exponent: with which power of the
/// information standard deviations fall.
std::string next_manoeuvre(const Answered& answered, const GoalOptions& options,
                           const std::vector<Missing>& missing, std::optional<double> seconds_left,
                           double exponent);

}  // namespace egocal::detail
