// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The tables of docs/benchmarks.md that bench_solvers prints.
#pragma once

#include <map>
#include <string>

#include "markdown_tables.hpp"

namespace egocal::bench {

/// Of a benchmark by its name: the median of its processor time [s].
using Times = std::map<std::string, double>;

/// How long each solver takes. Solvers without a time have no row.
Table solver_times(const Times& times);

/// The project's goals, each with what was measured; "(missed)" where it is not reached. Goals of which a
/// time is missing have no row.
Table solver_goals(const Times& times);

}  // namespace egocal::bench
