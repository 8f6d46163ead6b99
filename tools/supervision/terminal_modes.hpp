// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <termios.h>
#include <unistd.h>

namespace egocal::tools {

/// The modes of the terminal as they were before programs that change them.
class TerminalModes {
 public:
  TerminalModes() { known_ = tcgetattr(STDIN_FILENO, &modes_) == 0; }
  /// Restores the modes, but not of a terminal that is another job's now.
  void restore() const {
    if (known_ && tcgetpgrp(STDIN_FILENO) == getpgrp()) tcsetattr(STDIN_FILENO, TCSADRAIN, &modes_);
  }

 private:
  struct termios modes_ {};
  bool known_ = false;
};

}  // namespace egocal::tools
