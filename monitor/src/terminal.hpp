// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "egocal/monitor/canvas.hpp"
#include "egocal/monitor/text.hpp"
#include "egocal/monitor/view.hpp"

namespace egocal::monitor {

struct TerminalOptions {
  std::optional<Charset> charset;  ///< empty: by the locale and the kind of terminal
  bool monochrome = false;
};

/// What has arrived from outside since the last look.
struct Interrupts {
  bool quit = false;     ///< SIGINT, SIGTERM, SIGHUP
  bool resized = false;  ///< also after a suspension: everything is to be drawn again
};

/// The screen under ncurses from construction to destruction. Standard error is captured meanwhile, because
/// lines of others would tear the screen. The terminal is restored however the process ends, except by
/// SIGKILL.
class Terminal {
 public:
  /// Null, with the reason: there is no terminal to draw on.
  static std::unique_ptr<Terminal> open(const TerminalOptions& options, std::string& why_not);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  Charset charset() const;
  int width() const;
  int height() const;
  /// Writes the cells that differ from what is on the screen.
  void show(const Canvas& canvas);
  void draw_anew();
  std::optional<KeyPress> key();
  /// Descriptors that are readable when a key or captured text is there. A signal interrupts any wait.
  std::vector<int> fds() const;
  Interrupts interrupts();
  /// Complete lines that were written to standard error.
  std::vector<std::string> captured();

 private:
  Terminal();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace egocal::monitor
