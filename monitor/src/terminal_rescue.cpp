// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "terminal_rescue.hpp"

#include <termios.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdio>
#include <initializer_list>

#include "curses.hpp"

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

}  // namespace

bool can(const char* capability) {
  const char* text = tigetstr(capability);
  return text != nullptr && text != reinterpret_cast<const char*>(-1);
}

void remember_modes() {
  rescue = Rescue();
  rescue.has_modes = tcgetattr(STDIN_FILENO, &rescue.modes) == 0;
}

void prepare_rescue() {
  for (const char* name : {"sgr0", "op", "rmkx", "cnorm", "rmcup"}) add_capability(name);
  if (can("rmcup")) return;
  for (char c : {'\r', '\n'}) rescue.sequence[rescue.length++] = c;
  add_capability("ed");
}

void remember_stderr(int real_stderr) {
  rescue.real_stderr = real_stderr;
}

void restore_modes_and_stderr() {
  if (rescue.has_modes) tcsetattr(STDIN_FILENO, TCSANOW, &rescue.modes);
  if (rescue.real_stderr >= 0) {
    std::fflush(stderr);
    dup2(rescue.real_stderr, STDERR_FILENO);
    close(rescue.real_stderr);
    rescue.real_stderr = -1;
  }
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

void default_signals() {
  for (int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGWINCH, SIGTSTP})
    handle(signal_number, SIG_DFL);
  for (int signal_number : fatal_signals) handle(signal_number, SIG_DFL);
}

bool quit_asked() {
  return quit_flag != 0;
}

bool take_resize() {
  if (!resize_flag) return false;
  resize_flag = 0;
  return true;
}

bool take_suspend() {
  if (!suspend_flag) return false;
  suspend_flag = 0;
  return true;
}

void stop_here() {
  handle(SIGTSTP, SIG_DFL);
  raise(SIGTSTP);
  handle(SIGTSTP, on_suspend);
}

}  // namespace egocal::monitor
