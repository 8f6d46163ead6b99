// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The player beside a pairing process that is stopped or loses messages, in virtual time.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "player/player.hpp"
#include "support/virtual_time.hpp"

namespace egocal::services::test_keeping_in_step {
namespace {

using namespace std::chrono_literals;

class InStep : public ::testing::Test {
 protected:
  InStep()
      : file_(std::filesystem::temp_directory_path() /
              ("egocal_in_step_" + std::to_string(getpid()) + ".log")),
        network_(clock_),
        loop_(network_.transport(), clock_, {.handle_signals = false}),
        other_(network_.transport(), clock_, {.handle_signals = false}),
        pairing_(other_, {"egocal-pairing", bus::Role::pairing, "1.0", 1}, 3s),
        heartbeat_(loop_, {"egocal-player", bus::Role::player, "1.0", 2}, 3s) {
    bus::LogWriter log(file_.string());
    for (std::int64_t i = 0; i <= messages; ++i) {
      StampedPose pose;
      // the last one an hour later: the player does not end meanwhile
      pose.time_us = 1'600'000'000'000'000 + (i < messages ? 10'000 * i : 3'600'000'000);
      log.write(pose.time_us, "LIDAR", bus::encode(bus::to_message(pose, i)));
    }
    log.close();
    pairing_.set_state(bus::State::running);
    other_.subscribe_bytes("LIDAR", [this](const bus::Arrival& arrival) { take(arrival.bytes); });
    acknowledge(0, 0);
  }
  ~InStep() override { std::filesystem::remove(file_); }

  void acknowledge(std::int64_t utime, std::int64_t count) {
    acknowledgement_t entry{};
    entry.channel = "LIDAR";
    entry.utime = utime;
    entry.count = count;
    pairing_.acknowledgements() = {entry};
    pairing_.publish();
  }
  void take(bus::Bytes bytes) {
    odometry_t message{};
    ASSERT_TRUE(bus::decode(bytes, message));
    if (loses_ > 0) {
      --loses_;
      return;
    }
    ++heard_[message.seq];
    newest_ = std::max(newest_, message.utime);
    acknowledge(newest_, ++count_);
  }
  std::int64_t repeats() const {
    std::int64_t sum = 0;
    for (const auto& [number, times] : heard_) sum += times - 1;
    return sum;
  }

  static constexpr std::int64_t messages = 400;
  std::filesystem::path file_;
  test::VirtualClock clock_;
  test::VirtualNetwork network_;
  bus::Loop loop_, other_;
  bus::Heartbeat pairing_, heartbeat_;
  std::map<std::int64_t, std::int64_t> heard_;  ///< how often each number
  std::int64_t newest_ = 0, count_ = 0;
  int loses_ = 0;
};

TEST_F(InStep, NothingIsSentAgainToAProcessThatIsStopped) {
  Player player(loop_, heartbeat_, {.log = file_.string(), .range = {}});
  test::run_for(clock_, {&loop_, &other_}, 2s);
  EXPECT_GT(heard_.size(), 100u);
  test::run_for(clock_, {&loop_}, 8s);  // what is sent meanwhile waits in the socket
  test::run_for(clock_, {&loop_, &other_}, 5s);
  EXPECT_EQ(heard_.size(), static_cast<std::size_t>(messages));
  EXPECT_EQ(repeats(), 0);
}

// Listeners join the network one after the other: what is sent before pairing is heard may be lost.
TEST_F(InStep, WithoutANetworkAtTheStartTheLogWaitsForPairing) {
  test::run_for(clock_, {&loop_}, 10ms);  // what pairing has said already
  network_.set_away(true);
  Player player(loop_, heartbeat_, {.log = file_.string(), .range = {}});
  test::run_for(clock_, {&loop_, &other_}, 20s);
  EXPECT_EQ(heard_.size(), 0u);
  network_.set_away(false);
  loses_ = 2;
  test::run_for(clock_, {&loop_, &other_}, 15s);
  EXPECT_EQ(heard_.size(), static_cast<std::size_t>(messages));
}

// `egocal up` starts pairing until it works: what is played before is lost.
TEST_F(InStep, ForAsLongAsItShouldTheLogWaitsForPairing) {
  test::run_for(clock_, {&loop_}, 10ms);  // what pairing has said already
  pairing_.set_state(bus::State::waiting);
  std::string error;
  other_.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    if (status.role == "player") error = status.last_error;
  });
  PlayerOptions options{.log = file_.string(), .range = {}};
  options.pace.wait_for_pairing_us = 3'600'000'000;
  Player player(loop_, heartbeat_, options);
  test::run_for(clock_, {&loop_, &other_}, 3s);
  EXPECT_EQ(error, "");
  test::run_for(clock_, {&loop_, &other_}, 60s);
  EXPECT_EQ(heard_.size(), 0u);
  EXPECT_EQ(error, "waiting for a pairing process");
  pairing_.set_state(bus::State::running);
  acknowledge(0, 0);
  test::run_for(clock_, {&loop_, &other_}, 1500ms);
  EXPECT_EQ(error, "");
  test::run_for(clock_, {&loop_, &other_}, 15s);
  EXPECT_EQ(heard_.size(), static_cast<std::size_t>(messages));
}

// A seek is announced before the first message from there, to listeners that would miss what is skipped.
TEST_F(InStep, SeeksAreCountedInTheStatusAtOnce) {
  std::vector<std::int64_t> seeks;
  std::size_t heard_before = 0;
  other_.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    for (const counter_t& counter : status.counters)
      if (counter.name == "seeks" && (seeks.empty() || seeks.back() != counter.value)) {
        seeks.push_back(counter.value);
        heard_before = heard_.size();
      }
  });
  Player player(loop_, heartbeat_, {.log = file_.string(), .range = {}});
  test::run_for(clock_, {&loop_, &other_}, 1s);
  const std::size_t before = heard_.size();
  command_t command{};
  command.to = "egocal-player";
  for (const char* verb : {"seek 2", "seek 0.5"}) {
    command.verb = verb;
    other_.publish(bus::command_channel, command);
    test::run_for(clock_, {&loop_, &other_}, 5ms);
  }
  EXPECT_EQ(seeks, (std::vector<std::int64_t>{1, 2}));
  EXPECT_LE(heard_before, before + 1);
}

TEST_F(InStep, WhatIsLostAtTheEndIsSentAgain) {
  Player player(loop_, heartbeat_, {.log = file_.string(), .range = {}});
  test::run_for(clock_, {&loop_, &other_}, 3950ms);
  loses_ = 12;
  test::run_for(clock_, {&loop_, &other_}, 12s);
  EXPECT_EQ(heard_.size(), static_cast<std::size_t>(messages));
}

}  // namespace
}  // namespace egocal::services::test_keeping_in_step
