// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/cli/cli.hpp"

namespace egocal::tools {

/// `egocal experiment noise|online|globality`: Fig. 4, Fig. 6 and section V-F as CSV and plot.
void add_experiment(cli::App program);

}  // namespace egocal::tools
