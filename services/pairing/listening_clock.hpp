// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>

namespace egocal::services {

/// How long a process has been able to hear others [us]: a monotonic clock without the time in which the
/// process was stopped (SIGSTOP, Ctrl-Z, a machine that slept), or was reading what had arrived meanwhile.
class ListeningClock {
 public:
  /// look() is called once a period. If it was not for twice as long, the process was stopped.
  ListeningClock(std::chrono::microseconds period, std::int64_t mono_us)
      : longest_us_(2 * period.count()), looked_mono_us_(mono_us), listened_us_(mono_us) {}

  std::int64_t now_us(std::int64_t mono_us) const;
  /// read_all: nothing waits in the socket. True: the process was stopped since the last look.
  bool look(std::int64_t mono_us, bool read_all);
  /// Whether what came while this process was stopped is still to be read.
  bool catching_up() const { return catching_up_; }

 private:
  std::int64_t longest_us_;
  std::int64_t looked_mono_us_, listened_us_;  ///< at the last look
  bool catching_up_ = false;
};

}  // namespace egocal::services
