// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// A direction (0 to 5: x y z roll pitch yaw) whose standard deviation is this many times the wanted one;
/// infinite where the motions do not show it.
using Missing = std::pair<double, std::size_t>;

/// In a driver's words, the manoeuvre of the platform's catalogue to drive next: of those that bring a
/// missing direction to the goal much faster than more of the same driving, the one that brings all of them
/// nearest to it. It need not show all of them: the next advice is for what is missing then. Where none is
/// much faster, or other directions, which no manoeuvre shows, take as long anyway, the advice is to go on as
/// before. The information of a manoeuvre is added to that of the drive. exponent: with which power of the
/// information standard deviations fall.
std::string next_manoeuvre(const Answered& answered, const GoalOptions& options,
                           const std::vector<Missing>& missing, double exponent);

}  // namespace egocal::detail
