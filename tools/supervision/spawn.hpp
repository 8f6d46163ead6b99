// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <csignal>
#include <string>
#include <vector>

#include "supervision/restarts.hpp"

namespace egocal::tools {

/// Starts a program with this command line and signal mask. It gets SIGTERM when we are gone, and exits with
/// exec_failed where it cannot be executed. Not a foreground program: in a process group of its own, with its
/// output in this file descriptor (-1: where ours goes) and no input. -1: it could not be started for the
/// moment, errno says why.
pid_t spawn(const Program& program, std::vector<std::string> command, int output, const sigset_t& mask);

}  // namespace egocal::tools
