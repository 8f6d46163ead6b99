// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/heartbeat.hpp"
#include "player/in_flight.hpp"

namespace egocal::test {

/// Sends odometry in step with pairing, as egocal-player does: messages that were lost, or sent to a process
/// that was killed, are sent again. The kernel of a busy machine drops datagrams.
class SteadySender {
 public:
  explicit SteadySender(bus::Loop& loop)
      : loop_(loop), heartbeat_(loop, {"test-sender", bus::Role::player, "0"}, std::chrono::seconds(3)) {
    heartbeat_.set_state(bus::State::running);
    heartbeat_.on_status([this](const status_t& status) { hear(status); });
    heartbeat_.publish();
  }

  /// Whether pairing is alive, and one more message may be in flight.
  bool ready() const { return in_flight_.heard() && in_flight_.count() < most_in_flight; }
  bool all_taken() const { return in_flight_.count() == 0; }
  std::size_t on_the_way() const { return in_flight_.count(); }

  void send(const std::string& channel, std::vector<std::byte> bytes) {
    bus::LogEvent event{0, 0, channel, std::move(bytes)};
    loop_.publish_bytes(event.channel, event.data);
    if (all_taken()) progress_ = Clock::now();
    in_flight_.sent(event);
  }

  /// Call it now and then while waiting: messages that were not acknowledged for long are sent again.
  void watch_over() {
    if (all_taken() || Clock::now() - progress_ < std::chrono::milliseconds(500)) return;
    progress_ = Clock::now();
    send_again();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t most_in_flight = 48;

  void hear(const status_t& status) {
    if (status.role != "pairing" || status.state == "waiting" || status.state == "ended") return;
    const services::InFlight::Progress progress = in_flight_.acknowledged(status);
    if (progress.any) progress_ = Clock::now();
    if (progress.send_again) send_again();
  }
  void send_again() {
    for (const bus::LogEvent& event : in_flight_.all()) loop_.publish_bytes(event.channel, event.data);
  }

  bus::Loop& loop_;
  bus::Heartbeat heartbeat_;
  services::InFlight in_flight_;
  Clock::time_point progress_ = Clock::now();
};

}  // namespace egocal::test
