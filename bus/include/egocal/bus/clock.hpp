// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <poll.h>

#include <chrono>
#include <cstdint>
#include <span>

namespace egocal::bus {

/// The time of a loop, and its way of waiting. A simulation hands in a clock of its own: its
/// wait() returns at once and its time moves only when the simulation moves it.
class Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;

  /// Never runs backwards, the same for every process of a host [ns].
  virtual std::int64_t mono_ns() const = 0;
  /// Date, for people and for messages; may be set at any moment [us since 1970].
  virtual std::int64_t wall_us() const = 0;
  /// As poll(2): waits until one of the file descriptors is ready, at most this long. Negative: errno is set.
  virtual int wait(std::span<pollfd> fds, std::chrono::nanoseconds timeout) const = 0;

  std::int64_t mono_us() const { return mono_ns() / 1000; }
};

/// CLOCK_MONOTONIC, CLOCK_REALTIME and ppoll(2). Has no state: may be used from any thread.
const Clock& system_clock();

/// The times of system_clock() [us], see Clock::mono_us() and Clock::wall_us().
std::int64_t mono_us();
std::int64_t wall_us();

}  // namespace egocal::bus
