// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/clock.hpp"

namespace egocal::bus {

namespace {

class SystemClock final : public Clock {
 public:
  std::int64_t mono_ns() const override {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

  std::int64_t wall_us() const override {
    return std::chrono::duration_cast<std::chrono::microseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  }

  int wait(std::span<pollfd> fds, std::chrono::nanoseconds timeout) const override {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(timeout);
    const timespec time{seconds.count(), (timeout - seconds).count()};
    return ppoll(fds.data(), fds.size(), &time, nullptr);
  }
};

}  // namespace

const Clock& system_clock() {
  static const SystemClock clock;
  return clock;
}

std::int64_t mono_us() {
  return system_clock().mono_us();
}

std::int64_t wall_us() {
  return system_clock().wall_us();
}

}  // namespace egocal::bus
