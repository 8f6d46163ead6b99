// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/program_signals.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "egocal/error.hpp"

namespace egocal::tools {

ProgramSignals::ProgramSignals(bool has_terminal) {
  sigset_t mask;
  sigemptyset(&mask);
  for (const int signal : {SIGINT, SIGTERM, SIGCHLD, SIGHUP}) sigaddset(&mask, signal);
  if (has_terminal) sigaddset(&mask, SIGTSTP);
  descriptor_ = signalfd(-1, &mask, SFD_CLOEXEC | SFD_NONBLOCK);
  if (descriptor_ < 0) throw Error(std::string("signalfd: ") + std::strerror(errno));
  sigprocmask(SIG_BLOCK, &mask, &old_mask_);
  programs_mask_ = old_mask_;
  for (const int signal : {SIGINT, SIGTERM, SIGCHLD, SIGHUP, SIGTSTP}) sigdelset(&programs_mask_, signal);
}

ProgramSignals::~ProgramSignals() {
  close(descriptor_);
  sigprocmask(SIG_SETMASK, &old_mask_, nullptr);
}

std::optional<signalfd_siginfo> ProgramSignals::next() {
  signalfd_siginfo info;
  if (read(descriptor_, &info, sizeof info) != static_cast<ssize_t>(sizeof info)) return std::nullopt;
  return info;
}

}  // namespace egocal::tools
