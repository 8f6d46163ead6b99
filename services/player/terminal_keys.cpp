// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "player/terminal_keys.hpp"

#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace egocal::services {

namespace {

/// Whether this process is in the foreground. In the background (& in a shell) the keys belong to the shell,
/// and reading them would stop this process.
bool in_foreground() {
  return tcgetpgrp(STDIN_FILENO) == getpgrp();
}

}  // namespace

TerminalKeys::TerminalKeys() {
  if (!isatty(STDIN_FILENO) || tcgetattr(STDIN_FILENO, &before_) != 0 || !in_foreground()) return;
  std::signal(SIGTTOU, SIG_IGN);  // restoring the terminal must work from the background as well
  std::signal(SIGTTIN, SIG_IGN);
  termios keys = before_;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 1;
  keys.c_cc[VTIME] = 0;
  there_ = tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0;
}

TerminalKeys::~TerminalKeys() {
  if (there_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

std::string TerminalKeys::read() {
  char buffer[64];
  const ssize_t got = ::read(STDIN_FILENO, buffer, sizeof buffer);
  if (got > 0) return {buffer, static_cast<std::size_t>(got)};
  ended_ = got == 0 || (errno != EINTR && errno != EAGAIN);
  return {};
}

}  // namespace egocal::services
