// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simulation/world.hpp"

namespace egocal::simulation {

/// The simplest plan found that breaks the same promise: faults are switched off one by one. most_lives:
/// number of lives to try.
Plan shrink(const Plan& plan, char check, int most_lives = 300);

}  // namespace egocal::simulation
