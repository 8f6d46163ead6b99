// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/work_thread.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <system_error>

namespace egocal::bus {

WorkThread::WorkThread(const std::function<void()>& work) : fd_(eventfd(0, EFD_CLOEXEC)) {
  try {
    if (fd_ >= 0) thread_ = std::thread([this, &work] { run(work); });
  } catch (const std::system_error&) {
    close(fd_);
    fd_ = -1;
  }
  if (!thread_.joinable()) run(work);
}

WorkThread::~WorkThread() {
  if (thread_.joinable()) thread_.join();
  if (fd_ >= 0) close(fd_);
}

void WorkThread::run(const std::function<void()>& work) {
  try {
    work();
  } catch (...) {
    thrown_ = std::current_exception();
  }
  ended_ = true;
  if (fd_ >= 0) static_cast<void>(eventfd_write(fd_, 1));
}

void WorkThread::finish() {
  if (thread_.joinable()) thread_.join();
  if (thrown_) std::rethrow_exception(thrown_);
}

}  // namespace egocal::bus
