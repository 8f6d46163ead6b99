// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <thread>

namespace egocal::bus {

/// Work on a thread of its own, whose end a poll can wait for. Where the system gives no thread or no file
/// descriptor, as under `ulimit -u`, the constructor does the work.
class WorkThread {
 public:
  /// Work must exist until finish().
  explicit WorkThread(const std::function<void()>& work);
  /// Waits for the end of the work.
  ~WorkThread();
  WorkThread(const WorkThread&) = delete;
  WorkThread& operator=(const WorkThread&) = delete;

  /// Readable once the work has ended; -1: the constructor did it.
  int fd() const { return fd_; }
  bool ended() const { return ended_; }
  /// Waits for the end of the work and rethrows what it threw.
  void finish();

 private:
  void run(const std::function<void()>& work);

  int fd_ = -1;
  std::atomic<bool> ended_ = false;
  std::exception_ptr thrown_;
  std::thread thread_;
};

}  // namespace egocal::bus
