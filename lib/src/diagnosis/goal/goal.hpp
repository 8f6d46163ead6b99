// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Whether the motions have to show this direction (x y z roll pitch yaw). In planar mode z, roll and pitch
/// come from the ground planes.
bool expected(const Answered& answered, std::size_t direction);

/// A standard deviation from the motions [m, rad] with what an unknown scale and interpolation add to it.
double with_further_parts(double stddev, const Answered& answered, std::size_t direction);

/// Which directions are not known well enough yet, how long that takes at this driving, and the manoeuvre
/// that helps most.
Goal goal_of(const Answered& answered, const GoalOptions& options, const GoalSpreadOptions& tuning = {});

}  // namespace egocal::detail
