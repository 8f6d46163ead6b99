// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Standard deviation of each direction (x y z roll pitch yaw in sensor a's frame [m, rad]) for the
/// comparison with a goal, with a reserve for its own uncertainty. The reported standard deviations come from
/// about 20 blocks and scatter by a fifth; the first of many looks at which all six are below a goal comes at
/// a random time. The blocks of all directions together say by a third of that scatter how many times larger
/// the variances are than the inverse curvature. And where noise does not wander, that factor follows from
/// the squared residuals, which are known to a percent: how far it is taken from there depends on how well
/// both agree. As reported where that cannot be computed.
std::array<double, 6> goal_spread(const Answered& answered, const GoalSpreadOptions& options = {});

}  // namespace egocal::detail
