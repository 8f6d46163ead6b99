// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/cli/cli.hpp"

namespace egocal::tools {

void add_listen(cli::App program);

}  // namespace egocal::tools
