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
/// Of several threads that of one that computes counts: the others may wait for its result.
Activity activity(pid_t pid);

/// Adds what this process does; -1: none runs.
void add_work_of(pid_t pid, Work& work);

/// The time since the last call for a process, without its waits for a core: of a process that computes, only
/// the processor time that it has had since then. A process that gets a thirtieth of a core is slow, and does
/// not hang. passed: since the last call. processor: the processor time of the process at the last call, set
/// to that of now.
std::chrono::milliseconds without_waiting_for_a_core(pid_t pid, std::chrono::milliseconds passed,
                                                     std::chrono::nanoseconds& processor);

/// Stops this process after the programs that have its terminal, until SIGCONT, then continues them. A shell
/// takes the terminal when this process has stopped: a program must have given it back by then, or it would
/// be stopped a second time when it does. by_key: the terminal has sent it to them already. SIGTSTP is
/// blocked before and after.
void stop_until_continued(std::span<const pid_t> foreground, bool by_key);

}  // namespace egocal::tools
