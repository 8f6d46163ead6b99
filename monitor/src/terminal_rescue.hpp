// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How the process may end or be stopped without spoiling the terminal.
#pragma once

namespace egocal::monitor {

/// Whether the terminal has this capability of terminfo.
bool can(const char* capability);

/// Remembers the modes of standard input, before curses changes them.
void remember_modes();
/// Prepares the bytes that restore the terminal, for a crash in which no function may be called any more.
void prepare_rescue();
/// Standard error as it was before it was captured: a duplicate of the descriptor; -1: it was not.
void remember_stderr(int real_stderr);
/// Restores modes and standard error as they were.
void restore_modes_and_stderr();

/// From here on signals are kept for the functions below, and those of a crash restore the terminal first.
void handle_signals();
/// From here on signals act by default: an ending needs no care any more.
void default_signals();
/// Whether SIGINT, SIGTERM, SIGHUP or SIGQUIT has come.
bool quit_asked();
/// Whether the size has changed since the last call.
bool take_resize();
/// Whether a stop was asked for since the last call.
bool take_suspend();
/// Stops the process by the default action, as the shell expects; back after SIGCONT.
void stop_here();

}  // namespace egocal::monitor
