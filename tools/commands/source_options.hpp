// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/cli/cli.hpp"

#include "experiments/source.hpp"

namespace egocal::tools {

/// The options that say which data an experiment is run on: two files, or a simulated drive.
void add_source_options(cli::App command, Source& source);

/// Reads or simulates; what was assumed, repaired or lost while reading is printed as warnings.
DataSet load_warning(const Source& source);

}  // namespace egocal::tools
