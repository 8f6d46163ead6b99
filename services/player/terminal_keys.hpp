// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <termios.h>

#include <string>

namespace egocal::services {

/// Reads standard input as single keys without echo, if it is a terminal. The destructor restores its mode.
class TerminalKeys {
 public:
  TerminalKeys();
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  bool there() const { return there_; }
  /// The keys typed since the last call; empty: none, or another process has the terminal.
  std::string read();
  bool ended() const { return ended_; }

 private:
  bool there_ = false, ended_ = false;
  termios before_{};
};

}  // namespace egocal::services
