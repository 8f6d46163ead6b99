// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/cli/cli.hpp"

namespace egocal::tools {

/// `egocal compare`: every method on one data set, Tables I and II.
void add_compare(cli::App program);

}  // namespace egocal::tools
