// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whether processes compute, and how they stop together with this one.
#pragma once

#include <sys/types.h>

#include <span>

namespace egocal::tools {

/// It computes, or would if it got a core, or if it was not stopped.
bool has_work(pid_t pid);

/// It computes, or would if it got a core or its disk; one that is stopped does not.
bool computes(pid_t pid);

/// Stops this process after the programs that have its terminal, until SIGCONT, then continues them. A shell
/// takes the terminal when this process has stopped: a program must have given it back by then, or it would
/// be stopped a second time when it does. by_key: the terminal has sent it to them already. SIGTSTP is
/// blocked before and after.
void stop_until_continued(std::span<const pid_t> foreground, bool by_key);

}  // namespace egocal::tools
