// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "egocal/monitor/model.hpp"
#include "program.hpp"
#include "source.hpp"
#include "terminal.hpp"

namespace egocal::monitor {

/// Draws and takes keys until the user quits or the duration is over; the exit code.
int run_terminal(const ProgramOptions& options, Model& model, Source& source,
                 std::unique_ptr<Terminal> terminal);

}  // namespace egocal::monitor
