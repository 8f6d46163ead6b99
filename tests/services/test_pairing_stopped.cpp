// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A pairing process that is stopped and continued (Ctrl-Z and fg): the time in which it was stopped does not
// count as silence of the senders. Messages that wait in the socket, or that the player repeats, are not
// lost.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/rig.hpp"
#include "pairing/pairing.hpp"
#include "support/virtual_time.hpp"

namespace egocal::services::test_pairing_stopped {
namespace {

using namespace std::chrono_literals;

class StoppedPairing : public ::testing::Test {
 protected:
  static constexpr std::chrono::milliseconds period = 50ms;

  StoppedPairing()
      : network_(clock_),
        loop_(network_.transport(), clock_, {.handle_signals = false, .most_in_batch = 16}),
        others_(network_.transport(), clock_, {.handle_signals = false}),
        heartbeat_(loop_, {"egocal-pairing", bus::Role::pairing, "1.0", 1}, 3s),
        pairing_(loop_, heartbeat_, rig(), nullptr) {
    others_.subscribe<status_t>(bus::status_channel, [this](const status_t& status, const bus::Arrival&) {
      if (status.role != "pairing") return;
      for (const counter_t& counter : status.counters) counters_[counter.name] = counter.value;
    });
  }

  static bus::Rig rig() {
    return bus::parse_rig(
        "[[sensor]]\nname = \"a\"\nchannel = \"A\"\n[[sensor]]\nname = \"b\"\nchannel = \"B\"\n"
        "[[pair]]\na = \"a\"\nb = \"b\"\n",
        "rig.toml");
  }

  /// Message `number` of a channel, with the stamp that belongs to it.
  void send(const std::string& channel, std::int64_t number) {
    StampedPose pose;
    pose.time_us = 1'600'000'000'000'000 + number * std::chrono::microseconds(period).count();
    others_.publish_bytes(channel, bus::encode(bus::to_message(pose, number)));
  }
  /// Both sensors, from one number to before another; of B without the missing one.
  void drive(std::int64_t from, std::int64_t to, std::int64_t missing, bool listens) {
    for (std::int64_t number = from; number < to; ++number) {
      send("A", number);
      if (number != missing) send("B", number);
      listens ? test::run_for(clock_, {&loop_, &others_}, period) : test::run_for(clock_, {&others_}, period);
    }
  }

  test::VirtualClock clock_;
  test::VirtualNetwork network_;
  bus::Loop loop_, others_;
  bus::Heartbeat heartbeat_;
  Pairing pairing_;
  std::map<std::string, std::int64_t> counters_;
};

TEST_F(StoppedPairing, WhatAPlayerSendsAgainAfterwardsIsNotLost) {
  bus::Heartbeat player(others_, {"egocal-player", bus::Role::player, "1.0", 2}, 3s);
  player.set_state(bus::State::running);
  drive(0, 40, 39, true);
  drive(40, 45, -1, true);    // 39 of B is missing
  drive(45, 165, -1, false);  // stopped for six seconds
  test::run_for(clock_, {&loop_, &others_}, 400ms);
  send("B", 39);
  test::run_for(clock_, {&loop_, &others_}, 2s);
  EXPECT_EQ(counters_["lost"], 0);
  EXPECT_EQ(counters_["rejected: too late"], 0);
  EXPECT_EQ(counters_["rejected: duplicate"], 0);
  EXPECT_EQ(counters_["in"], 330);
}

TEST_F(StoppedPairing, WhatWaitsInTheSocketIsReadBeforeAnythingCountsAsMissing) {
  drive(0, 40, 39, true);
  send("B", 40);
  test::run_for(clock_, {&loop_, &others_}, 10ms);
  // stopped as soon as 39 was overtaken by 40; it comes, behind what the other sensor has sent meanwhile
  for (std::int64_t number = 40; number < 80; ++number) send("A", number);
  send("B", 39);
  test::run_for(clock_, {&others_}, 6s);
  test::run_for(clock_, {&loop_, &others_}, 2s);
  EXPECT_EQ(counters_["lost"], 0);
  EXPECT_EQ(counters_["rejected: too late"], 0);
}

TEST_F(StoppedPairing, WhatNeverComesIsGivenUpAfterwards) {
  drive(0, 45, 39, true);
  test::run_for(clock_, {&others_}, 6s);
  test::run_for(clock_, {&loop_, &others_}, 3s);
  EXPECT_EQ(counters_["lost"], 1);
}

}  // namespace
}  // namespace egocal::services::test_pairing_stopped
