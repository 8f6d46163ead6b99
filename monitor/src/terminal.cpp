// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "terminal.hpp"

#include <fcntl.h>
#include <langinfo.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "curses.hpp"
#include "terminal_rescue.hpp"

namespace egocal::monitor {
namespace {

// Returns to the shell. On a terminal without a second screen the last picture stays, with the prompt on a
// new line below it.
void leave() {
  if (!can("rmcup")) {
    move(getmaxy(stdscr) - 1, 0);
    clrtoeol();
    refresh();
  }
  endwin();
}

// Colours by meaning; where there are none, by weight.
attr_t attributes(Style style, bool colours) {
  switch (style) {
    case Style::normal:
      return A_NORMAL;
    case Style::dim:
      return colours ? A_DIM : A_NORMAL;
    case Style::strong:
      return A_BOLD;
    case Style::title:
      return A_BOLD;
    case Style::good:
      return A_NORMAL;
    case Style::warning:
      return A_BOLD;
    case Style::bad:
      return colours ? A_BOLD : A_REVERSE;
    case Style::fast:
      return A_NORMAL;
    case Style::global:
      return colours ? A_NORMAL : A_BOLD;
    case Style::threshold:
      return A_NORMAL;
    case Style::key:
      return A_BOLD;
    case Style::count_:
      break;
  }
  return A_NORMAL;
}

short colour(Style style) {
  switch (style) {
    case Style::good:
      return COLOR_GREEN;
    case Style::warning:
    case Style::threshold:
      return COLOR_YELLOW;
    case Style::bad:
      return COLOR_RED;
    case Style::fast:
    case Style::key:
      return COLOR_CYAN;
    case Style::global:
      return COLOR_MAGENTA;
    default:
      return -1;
  }
}

}  // namespace

struct Terminal::State {
  SCREEN* screen = nullptr;
  Charset charset = Charset::ascii;
  bool colours = false;
  std::array<int, 2> capture{-1, -1};
  std::string partial;
  Canvas shown{0, 0};
  bool all = true;
};

Terminal::Terminal() : state_(std::make_unique<State>()) {}

namespace {

/// Why nothing can be drawn on standard output; empty: it can.
std::string why_no_terminal() {
  if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO)) return "standard input and output are no terminal";
  const char* kind = std::getenv("TERM");
  int error = 0;
  if (kind == nullptr || setupterm(kind, STDOUT_FILENO, &error) != OK) return "TERM names no known terminal";
  if (!can("cup") || !can("clear"))
    return std::string("terminal '") + clean(kind, 20) + "' cannot move its cursor";
  return "";
}

Charset charset_for(const std::optional<Charset>& wanted) {
  if (std::strcmp(nl_langinfo(CODESET), "UTF-8") != 0) return Charset::ascii;
  // the Linux console has no braille, a vt100 has no UTF-8
  const std::string_view kind = std::getenv("TERM");
  const bool plain = kind == "linux" || kind.starts_with("vt1") || kind.starts_with("vt2");
  return wanted.value_or(plain ? Charset::ascii : Charset::unicode);
}

/// Starts colours. False: the terminal or its user wants none.
bool start_colours(bool monochrome) {
  const char* no_color = std::getenv("NO_COLOR");
  if (monochrome || (no_color != nullptr && *no_color != '\0') || !has_colors()) return false;
  start_color();
  const bool defaults = use_default_colors() == OK;
  for (int i = 1; i < static_cast<int>(Style::count_); ++i) {
    const short wanted = colour(static_cast<Style>(i));
    init_pair(static_cast<short>(i), wanted < 0 && !defaults ? static_cast<short>(COLOR_WHITE) : wanted,
              static_cast<short>(defaults ? -1 : COLOR_BLACK));
  }
  return true;
}

void start_input() {
  cbreak();
  noecho();
  nonl();
  keypad(stdscr, TRUE);
  nodelay(stdscr, TRUE);
  set_escdelay(25);
  curs_set(0);
}

/// Captures standard error, which would tear the screen. Its lines become events.
void capture_errors(std::array<int, 2>& capture) {
  if (pipe2(capture.data(), O_CLOEXEC | O_NONBLOCK) != 0) return;
  std::fflush(stderr);
  remember_stderr(fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3));
  dup2(capture[1], STDERR_FILENO);
}

}  // namespace

std::unique_ptr<Terminal> Terminal::open(const TerminalOptions& options, std::string& why_not) {
  why_not = why_no_terminal();
  if (!why_not.empty()) return nullptr;
  remember_modes();

  std::unique_ptr<Terminal> terminal(new Terminal());
  State& s = *terminal->state_;
  s.screen = newterm(nullptr, stdout, stdin);
  if (s.screen == nullptr) {
    why_not = std::string("terminal '") + clean(std::getenv("TERM"), 20) + "' cannot be opened";
    return nullptr;
  }
  prepare_rescue();
  s.charset = charset_for(options.charset);
  s.colours = start_colours(options.monochrome);
  start_input();
  capture_errors(s.capture);
  handle_signals();
  return terminal;
}

Terminal::~Terminal() {
  State& s = *state_;
  if (s.screen != nullptr) {
    leave();
    delscreen(s.screen);
  }
  restore_modes_and_stderr();
  for (int fd : s.capture)
    if (fd >= 0) close(fd);
  default_signals();
}

Charset Terminal::charset() const {
  return state_->charset;
}
int Terminal::width() const {
  return getmaxx(stdscr);
}
int Terminal::height() const {
  return getmaxy(stdscr);
}

void Terminal::draw_anew() {
  state_->all = true;
  clearok(stdscr, TRUE);
}

void Terminal::show(const Canvas& canvas) {
  State& s = *state_;
  if (canvas.width() != s.shown.width() || canvas.height() != s.shown.height()) s.all = true;
  if (s.all) erase();
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      const Cell& cell = canvas.at(x, y);
      if (!s.all && cell == s.shown.at(x, y)) continue;
      if (s.all && cell == Cell{}) continue;
      attr_t weight = attributes(cell.style, s.colours);
      if (cell.reverse) weight ^= A_REVERSE;
      const short pair = s.colours && cell.style != Style::normal ? static_cast<short>(cell.style) : short{0};
      const wchar_t text[2] = {
          static_cast<wchar_t>(s.charset == Charset::ascii && cell.glyph > 0x7e ? U'?' : cell.glyph), L'\0'};
      cchar_t out{};
      setcchar(&out, text, weight, pair, nullptr);
      mvadd_wch(y, x, &out);
    }
  }
  s.shown = canvas;
  s.all = false;
  refresh();
}

std::optional<KeyPress> Terminal::key() {
  for (;;) {
    const int code = getch();
    switch (code) {
      case ERR:
        return std::nullopt;
      case KEY_UP:
        return KeyPress{Key::up, 0};
      case KEY_DOWN:
        return KeyPress{Key::down, 0};
      case KEY_LEFT:
        return KeyPress{Key::left, 0};
      case KEY_RIGHT:
        return KeyPress{Key::right, 0};
      case KEY_PPAGE:
        return KeyPress{Key::page_up, 0};
      case KEY_NPAGE:
        return KeyPress{Key::page_down, 0};
      case KEY_HOME:
        return KeyPress{Key::home, 0};
      case KEY_END:
        return KeyPress{Key::end, 0};
      case KEY_ENTER:
      case '\r':
      case '\n':
        return KeyPress{Key::enter, 0};
      case KEY_BACKSPACE:
      case 0x7f:
      case 0x08:
      case 0x1b:
        return KeyPress{Key::escape, 0};
      case '\t':
        return KeyPress{Key::tab, 0};
      case 0x0c:
        draw_anew();
        continue;  // Ctrl-L
      default:
        if (code >= 0x20 && code < 0x7f) return KeyPress{Key::character, static_cast<char>(code)};
    }
  }
}

std::vector<int> Terminal::fds() const {
  std::vector<int> all{STDIN_FILENO};
  if (state_->capture[0] >= 0) all.push_back(state_->capture[0]);
  return all;
}

Interrupts Terminal::interrupts() {
  Interrupts result;
  const bool stopped = take_suspend();
  if (stopped) {
    leave();
    stop_here();
  }
  if (take_resize() || stopped) {
    struct winsize size {};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 && size.ws_col > 0)
      resizeterm(size.ws_row, size.ws_col);
    draw_anew();
    result.resized = true;
  }
  result.quit = quit_asked();
  return result;
}

std::vector<std::string> Terminal::captured() {
  State& s = *state_;
  std::vector<std::string> result;
  if (s.capture[0] < 0) return result;
  char buffer[4096];
  ssize_t n = 0;
  while (result.size() < 100 && (n = read(s.capture[0], buffer, sizeof buffer)) > 0) {
    for (ssize_t i = 0; i < n; ++i) {
      if (buffer[i] == '\n') {
        if (!s.partial.empty()) result.push_back(s.partial);
        s.partial.clear();
      } else if (s.partial.size() < 400) {
        s.partial += buffer[i];
      }
    }
  }
  return result;
}

}  // namespace egocal::monitor
