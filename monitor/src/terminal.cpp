// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "terminal.hpp"

#define NCURSES_WIDECHAR 1
#include <curses.h>
#include <fcntl.h>
#include <langinfo.h>
#include <sys/ioctl.h>
#include <term.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>

// curses.h and term.h define these as macros
#undef lines
#undef columns
#undef tab
#undef key

namespace egocal::monitor {
namespace {

// Data for signal handlers: plain memory, set up before the handlers are installed.
constexpr std::size_t sequence_length = 250;
struct Rescue {
  struct termios modes {};
  bool has_modes = false;
  char sequence[sequence_length + 2] = {};
  std::size_t length = 0;
  int real_stderr = -1;
};
Rescue rescue;
volatile std::sig_atomic_t quit_flag = 0;
volatile std::sig_atomic_t resize_flag = 0;
volatile std::sig_atomic_t suspend_flag = 0;
alignas(16) char crash_stack[64 * 1024];

constexpr int fatal_signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

extern "C" void on_quit(int) {
  quit_flag = 1;
}
extern "C" void on_resize(int) {
  resize_flag = 1;
}
extern "C" void on_suspend(int) {
  suspend_flag = 1;
}

// Only async-signal-safe calls: the process is about to end and the terminal must be restored.
extern "C" void on_crash(int signal_number) {
  if (rescue.length > 0) {
    const auto written = write(STDOUT_FILENO, rescue.sequence, rescue.length);
    static_cast<void>(written);
  }
  if (rescue.has_modes) tcsetattr(STDIN_FILENO, TCSANOW, &rescue.modes);
  if (rescue.real_stderr >= 0) dup2(rescue.real_stderr, STDERR_FILENO);
  signal(signal_number, SIG_DFL);
  raise(signal_number);
}

void handle(int signal_number, void (*handler)(int), int flags = 0) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal_number, &action, nullptr);
}

// A capability's string without its padding "$<5>".
void add_capability(const char* name) {
  const char* text = tigetstr(name);
  if (text == nullptr || text == reinterpret_cast<const char*>(-1)) return;
  for (const char* c = text; *c != '\0' && rescue.length < sequence_length;) {
    if (c[0] == '$' && c[1] == '<') {
      while (*c != '\0' && *c != '>') ++c;
      if (*c == '>') ++c;
      continue;
    }
    rescue.sequence[rescue.length++] = *c++;
  }
}

bool can(const char* capability) {
  const char* text = tigetstr(capability);
  return text != nullptr && text != reinterpret_cast<const char*>(-1);
}

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

/// Prepares the bytes that restore the terminal, for a crash in which no function may be called any more.
void prepare_rescue() {
  for (const char* name : {"sgr0", "op", "rmkx", "cnorm", "rmcup"}) add_capability(name);
  if (can("rmcup")) return;
  for (char c : {'\r', '\n'}) rescue.sequence[rescue.length++] = c;
  add_capability("ed");
}

Charset charset_for(const std::optional<Charset>& wanted) {
  if (std::strcmp(nl_langinfo(CODESET), "UTF-8") != 0) return Charset::ascii;
  // the Linux console has no braille, a vt100 has no UTF-8
  const std::string_view kind = std::getenv("TERM");
  const bool plain = kind == "linux" || kind.starts_with("vt1") || kind.starts_with("vt2");
  return wanted.value_or(plain ? Charset::ascii : Charset::unicode);
}

/// False: the terminal or its user wants none.
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
  rescue.real_stderr = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  dup2(capture[1], STDERR_FILENO);
}

void handle_signals() {
  quit_flag = 0;
  resize_flag = 0;
  suspend_flag = 0;
  for (int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) handle(signal_number, on_quit);
  handle(SIGWINCH, on_resize);
  handle(SIGTSTP, on_suspend);
  handle(SIGPIPE, SIG_IGN);
  stack_t stack{};
  stack.ss_sp = crash_stack;
  stack.ss_size = sizeof crash_stack;
  sigaltstack(&stack, nullptr);
  for (int signal_number : fatal_signals)
    handle(signal_number, on_crash, static_cast<int>(SA_ONSTACK | SA_RESETHAND));
}

}  // namespace

std::unique_ptr<Terminal> Terminal::open(const TerminalOptions& options, std::string& why_not) {
  why_not = why_no_terminal();
  if (!why_not.empty()) return nullptr;
  rescue = Rescue();
  rescue.has_modes = tcgetattr(STDIN_FILENO, &rescue.modes) == 0;

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
  if (rescue.has_modes) tcsetattr(STDIN_FILENO, TCSANOW, &rescue.modes);
  if (rescue.real_stderr >= 0) {
    std::fflush(stderr);
    dup2(rescue.real_stderr, STDERR_FILENO);
    close(rescue.real_stderr);
    rescue.real_stderr = -1;
  }
  for (int fd : s.capture)
    if (fd >= 0) close(fd);
  // from here on an ending needs no care
  for (int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGWINCH, SIGTSTP})
    handle(signal_number, SIG_DFL);
  for (int signal_number : fatal_signals) handle(signal_number, SIG_DFL);
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
  if (suspend_flag) {
    suspend_flag = 0;
    leave();
    // stopped by the default action, as the shell expects; back here after SIGCONT
    handle(SIGTSTP, SIG_DFL);
    raise(SIGTSTP);
    handle(SIGTSTP, on_suspend);
    resize_flag = 1;
  }
  if (resize_flag) {
    resize_flag = 0;
    struct winsize size {};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 && size.ws_col > 0)
      resizeterm(size.ws_row, size.ws_col);
    draw_anew();
    result.resized = true;
  }
  result.quit = quit_flag != 0;
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
