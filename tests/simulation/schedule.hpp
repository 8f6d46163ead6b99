// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace egocal::simulation {

/// The one clock of the simulation, and the events planned on it. Events of the same time happen in the order
/// in which they were planned.
class Schedule {
 public:
  using Action = std::function<void()>;
  static constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

  std::int64_t now_ns() const { return now_ns_; }
  std::int64_t now_us() const { return now_ns_ / 1000; }

  void at(std::int64_t time_ns, Action action) {
    planned_.push_back({std::max(time_ns, now_ns_), order_++, std::move(action)});
    std::push_heap(planned_.begin(), planned_.end(), later);
  }
  void after_us(std::int64_t delay_us, Action action) { at(now_ns_ + 1000 * delay_us, std::move(action)); }

  std::int64_t next_ns() const { return planned_.empty() ? never : planned_.front().at_ns; }
  void go_to(std::int64_t time_ns) { now_ns_ = std::max(now_ns_, time_ns); }
  /// Must not be empty.
  void do_next() {
    std::pop_heap(planned_.begin(), planned_.end(), later);
    Planned next = std::move(planned_.back());
    planned_.pop_back();
    go_to(next.at_ns);
    next.action();
  }

 private:
  struct Planned {
    std::int64_t at_ns;
    std::uint64_t order;
    Action action;
  };
  static bool later(const Planned& x, const Planned& y) {
    return x.at_ns != y.at_ns ? x.at_ns > y.at_ns : x.order > y.order;
  }
  std::vector<Planned> planned_;
  std::int64_t now_ns_ = 0;
  std::uint64_t order_ = 0;
};

}  // namespace egocal::simulation
