// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Standard deviation of each direction (x y z roll pitch yaw in sensor a's frame [m, rad]) for the
/// comparison with a goal, with a reserve for its own uncertainty. The reported standard deviations come from
/// about 20 blocks and scatter by a fifth; the first of many looks at which all six are below a goal comes
/// late, and at a random time. The blocks of all directions together say by half that much scatter how many
/// times larger the errors are than those of white noise. A direction keeps its own factor as far as it
/// differs from the common one by more than chance. As reported where that cannot be computed.
std::array<double, 6> goal_spread(const Answered& answered, const GoalSpreadOptions& options = {});

}  // namespace egocal::detail
