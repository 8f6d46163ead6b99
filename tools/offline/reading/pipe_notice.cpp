// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/reading/pipe_notice.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>

#include "egocal/printable.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

constexpr int patience_ms = 1000;  // a limit: people wonder after that

bool may_keep_waiting(const std::string& file) {
  struct stat status {};
  return stat(file.c_str(), &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode));
}

}  // namespace

PipeNotice::PipeNotice(const std::string& file)
    : file_(file),
      arrived_(may_keep_waiting(file) ? eventfd(0, EFD_CLOEXEC) : -1),
      work_([this] { wait(); }) {
  if (arrived_.get() >= 0) thread_ = std::make_unique<bus::WorkThread>(work_);
}

PipeNotice::~PipeNotice() {
  if (arrived_.get() >= 0) static_cast<void>(eventfd_write(arrived_.get(), 1));
}

void PipeNotice::wait() const {
  pollfd arrived{arrived_.get(), POLLIN, 0};
  if (poll(&arrived, 1, patience_ms) == 0) say("egocal: waiting for data from " + printable(file_));
}

}  // namespace egocal::tools
