// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What processes do, and how they stop together with this one.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <span>

#include "supervision/last_answers.hpp"

namespace egocal::tools {

enum class Activity {
  waits,     ///< for messages or a time, or it has ended
  computes,  ///< or would if it got a core
  disk,      ///< waits for its disk
  stopped,
};
Activity activity(pid_t pid);

/// Adds what this process does; -1: none runs.
void add_work_of(pid_t pid, Work& work);

/// Of the time that has passed since the last call for a process: of one that computes only what it has had
/// of a core. One that gets a thirtieth of it is slow, and does not hang. processor: that it had had at the
/// last call, and has had now.
std::chrono::milliseconds without_waiting_for_a_core(pid_t pid, std::chrono::milliseconds passed,
                                                     std::chrono::nanoseconds& processor);

/// Stops this process after the programs that have its terminal, until SIGCONT, then continues them. A shell
/// takes the terminal when this process has stopped: a program must have given it back by then, or it would
/// be stopped a second time when it does. by_key: the terminal has sent it to them already. SIGTSTP is
/// blocked before and after.
void stop_until_continued(std::span<const pid_t> foreground, bool by_key);

}  // namespace egocal::tools
