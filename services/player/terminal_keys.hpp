// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <termios.h>

#include <string>

namespace egocal::services {

/// Standard input as single keys without echo, where it is a terminal; as it was before when the object goes.
class TerminalKeys {
 public:
  TerminalKeys();
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  bool there() const { return there_; }
  /// What was typed; empty: nothing, or another process has the terminal.
  std::string read();
  bool ended() const { return ended_; }

 private:
  bool there_ = false, ended_ = false;
  termios before_{};
};

}  // namespace egocal::services
