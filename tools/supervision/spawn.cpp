// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/spawn.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace egocal::tools {

namespace {

/// Becomes the program. Runs in the child, between fork and exec: only what is safe there.
[[noreturn]] void become(const Program& program, char* const* arguments, int output, pid_t parent,
                         const sigset_t& mask) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // whatever happens to us, nothing is left behind
  if (getppid() != parent) _exit(exec_failed);
  if (!program.foreground) setpgid(0, 0);
  signal(SIGPIPE, SIG_DFL);  // that it is ignored would be inherited
  sigprocmask(SIG_SETMASK, &mask, nullptr);
  if (!program.foreground) {
    if (output >= 0) {
      dup2(output, STDOUT_FILENO);
      dup2(output, STDERR_FILENO);
    }
    const int null = open("/dev/null", O_RDONLY);
    if (null >= 0) dup2(null, STDIN_FILENO);
  }
  execv(arguments[0], arguments);
  constexpr char text[] = "cannot be started\n";
  if (write(STDERR_FILENO, text, sizeof text - 1) < 0) _exit(exec_failed);
  _exit(exec_failed);
}

}  // namespace

pid_t spawn(const Program& program, std::vector<std::string> command, int output, const sigset_t& mask) {
  std::vector<char*> arguments;
  for (std::string& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become(program, arguments.data(), output, parent, mask);
  return pid;
}

}  // namespace egocal::tools
