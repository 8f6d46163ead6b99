// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ending_signals.hpp"

#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "egocal/error.hpp"

namespace egocal::bus {

EndingSignals::EndingSignals(bool wanted) {
  if (!wanted) return;
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &set, &before_);
  fd_ = signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
  if (fd_ >= 0) return;
  const int reason = errno;
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  throw Error(std::string("cannot receive signals: ") + std::strerror(reason));
}

EndingSignals::~EndingSignals() {
  if (fd_ < 0) return;
  close(fd_);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

int EndingSignals::read_one() const {
  signalfd_siginfo info{};
  return ::read(fd_, &info, sizeof info) == sizeof info ? static_cast<int>(info.ssi_signo) : 0;
}

}  // namespace egocal::bus
