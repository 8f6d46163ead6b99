// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/datagrams.hpp"
#include "egocal/bus/loop.hpp"

namespace egocal::test {

/// A clock that only the test moves. Waiting takes no time.
class VirtualClock final : public bus::Clock {
 public:
  std::int64_t mono_ns() const override { return mono_ns_; }
  std::int64_t wall_us() const override { return wall_start_us + mono_ns_ / 1000 + wall_step_us_; }
  int wait(std::span<pollfd>, std::chrono::nanoseconds) const override { return 0; }

  void advance(std::chrono::nanoseconds time) { mono_ns_ += time.count(); }
  void set_to(std::int64_t mono_ns) { mono_ns_ = mono_ns; }
  /// Sets the date on by this time [us].
  void step_wall(std::int64_t us) { wall_step_us_ += us; }

 private:
  static constexpr std::int64_t wall_start_us = 1'700'000'000'000'000;
  std::int64_t mono_ns_ = 1'000'000'000;
  std::int64_t wall_step_us_ = 0;
};

/// A network within one process: a message of one transport reaches all of them at once, in order.
class VirtualNetwork {
 public:
  explicit VirtualNetwork(const bus::Clock& clock) : clock_(clock) {}

  std::unique_ptr<bus::Transport> transport();
  /// While it is away nothing is sent, and every transport reports it.
  void set_away(bool away) { away_ = away; }

 private:
  struct Message {
    std::string channel;
    std::vector<std::byte> bytes;
    std::int64_t mono_us = 0;
  };
  using Inbox = std::deque<Message>;
  class End;

  const bus::Clock& clock_;
  std::vector<std::weak_ptr<Inbox>> inboxes_;
  bool away_ = false;
};

class VirtualNetwork::End final : public bus::Transport {
 public:
  End(VirtualNetwork& network, std::shared_ptr<Inbox> inbox) : network_(network), inbox_(std::move(inbox)) {}

  bus::SendStatus send(std::string_view channel, bus::Bytes bytes) override {
    if (!bus::fits_datagrams(channel, bytes)) return bus::SendStatus::too_large;
    if (network_.away_) return bus::SendStatus::no_network;
    for (const auto& inbox : network_.inboxes_)
      if (const auto there = inbox.lock())
        there->push_back({std::string(channel), {bytes.begin(), bytes.end()}, network_.clock_.mono_us()});
    return bus::SendStatus::sent;
  }

  bool receive(const Wanted& wanted, bus::Received& message) override {
    while (!inbox_->empty()) {
      current_ = std::move(inbox_->front());
      inbox_->pop_front();
      if (!wanted(current_.channel)) continue;
      message = {current_.channel, current_.bytes, current_.mono_us};
      return true;
    }
    return false;
  }

  int fd() const override { return -1; }
  bool ready() const override { return !inbox_->empty(); }
  void check_network() override {}
  std::string network_error() const override { return network_.away_ ? "no multicast: away" : ""; }
  bus::TransportCounts counts() const override { return {}; }

 private:
  VirtualNetwork& network_;
  std::shared_ptr<Inbox> inbox_;
  Message current_;
};

inline std::unique_ptr<bus::Transport> VirtualNetwork::transport() {
  const auto inbox = std::make_shared<Inbox>();
  inboxes_.push_back(inbox);
  return std::make_unique<End>(*this, inbox);
}

/// Runs all loops for this long in virtual time, from timer to timer.
inline void run_for(VirtualClock& clock, const std::vector<bus::Loop*>& loops,
                    std::chrono::nanoseconds time) {
  const std::int64_t end = clock.mono_ns() + time.count();
  for (;;) {
    // twice: what the last loop sends is for the first one, too
    for (int turn = 0; turn < 2; ++turn)
      for (bus::Loop* loop : loops) loop->run_once(std::chrono::nanoseconds{0});
    std::int64_t next = end + 1;
    for (const bus::Loop* loop : loops) next = std::min(next, loop->next_timer_ns().value_or(next));
    if (next > end) break;
    clock.set_to(std::max(next, clock.mono_ns()));
  }
  clock.set_to(end);
}

}  // namespace egocal::test
