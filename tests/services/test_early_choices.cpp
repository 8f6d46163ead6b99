// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The first second of a large rig: each answer needs a choice of weights of its own, in which all messages
// wait.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "pairing/pairing.hpp"
#include "support/simulated_drive.hpp"
#include "support/virtual_time.hpp"

namespace egocal::services::test_early_choices {
namespace {

using namespace std::chrono_literals;

struct Sent {
  std::int64_t mono_us = 0;
  problem_t problem{};
};

/// One sensor beside five others, at 100 Hz.
class EarlyChoices : public ::testing::Test {
 protected:
  static constexpr int pairs = 5;
  static constexpr std::int64_t early = 16, first_choice = 64;  ///< instants, of AccumulatorOptions

  EarlyChoices()
      : network_(clock_),
        loop_(network_.transport(), clock_, {.handle_signals = false}),
        others_(network_.transport(), clock_, {.handle_signals = false}),
        heartbeat_(loop_, {"egocal-pairing", bus::Role::pairing, "1.0", 1}, 3s),
        pairing_(loop_, heartbeat_, rig(), nullptr) {
    for (int k = 0; k < pairs; ++k)
      others_.subscribe<problem_t>(bus::problem_channel("s", sensor(k)),
                                   [this, k](const problem_t& problem, const bus::Arrival&) {
                                     sent_[k].push_back({clock_.mono_us(), problem});
                                   });
    run(1s);  // it has begun to send
  }

  static std::string sensor(int k) { return std::string(1, static_cast<char>('a' + k)); }
  static bus::Rig rig() {
    std::string text = "[[sensor]]\nname = \"s\"\nchannel = \"S\"\n";
    for (int k = 0; k < pairs; ++k)
      text += "[[sensor]]\nname = \"" + sensor(k) + "\"\nchannel = \"ODO_" + sensor(k) +
              "\"\n[[pair]]\na = \"s\"\nb = \"" + sensor(k) + "\"\n";
    return bus::parse_rig(text, "rig.toml");
  }
  void run(std::chrono::milliseconds time) { test::run_for(clock_, {&loop_, &others_}, time); }
  /// Poses [from, to), 10 ms apart; of the sensors from this one on.
  void send(std::size_t from, std::size_t to, int first = 0) {
    for (std::size_t i = from; i < to; ++i) {
      const auto number = static_cast<std::int64_t>(i);
      others_.publish_bytes("S", bus::encode(bus::to_message(streams_.a[i], number)));
      for (int k = first; k < pairs; ++k)
        others_.publish_bytes("ODO_" + sensor(k), bus::encode(bus::to_message(streams_.b[i], number)));
      run(10ms);
    }
  }

  testing::Streams streams_ =
      testing::simulated_drive({.terrain = Terrain::free, .poses = 100, .rate = 100, .relative_noise = 0.01});
  test::VirtualClock clock_;
  test::VirtualNetwork network_;
  bus::Loop loop_, others_;
  bus::Heartbeat heartbeat_;
  Pairing pairing_;
  std::map<int, std::vector<Sent>> sent_;
};

TEST_F(EarlyChoices, TakeTurnsAndEndWithTheLastMotion) {
  send(0, 50);
  run(200ms);
  std::vector<std::int64_t> times;
  for (const auto& [k, all] : sent_) {
    EXPECT_EQ(all.back().problem.seq, 49) << "of the last pose, though no more come";
    std::int64_t before = 0;
    for (const Sent& one : all) {
      if (one.problem.seq < early) continue;
      times.push_back(one.mono_us);
      if (before > 0) {
        EXPECT_LE(one.mono_us - before, (pairs + 2) * 10'000) << k;
      }
      before = one.mono_us;
    }
  }
  std::sort(times.begin(), times.end());
  EXPECT_GT(times.size(), 30u);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GE(times[i] - times[i - 1], 9'000) << i;
}

// Which answers there are depends on the speed, but not what they are.
TEST_F(EarlyChoices, AreThoseOfTheSamePosesAtAnySpeed) {
  send(0, streams_.a.size());
  run(200ms);
  MotionPairing expected(bus::drive_options(rig(), rig().pairs[0]));
  std::map<std::int64_t, Problem> by_motions;
  for (std::size_t i = 0; i < streams_.a.size(); ++i) {
    expected.push(Side::a, streams_.a[i]);
    expected.push(Side::b, streams_.b[i]);
    by_motions[static_cast<std::int64_t>(expected.synchronised()) - 1] = expected.problem();
  }
  int compared = 0;
  for (const Sent& one : sent_[0]) {
    const auto same = by_motions.find(one.problem.seq);
    ASSERT_NE(same, by_motions.end());
    const bus::Checked<Problem> read = bus::to_problem(one.problem);
    ASSERT_TRUE(read.value);
    // poses that went over the bus are rounded
    EXPECT_TRUE(
        sum_blocks(read.value->blocks).dual_rows.isApprox(sum_blocks(same->second.blocks).dual_rows, 1e-6))
        << one.problem.seq;
    compared += one.problem.seq >= early && one.problem.seq < first_choice;
  }
  EXPECT_GT(compared, 5);
}

// A pair that was reset has a new motion that is never sent.
TEST_F(EarlyChoices, AResetPairDoesNotBlockTheOthers) {
  send(0, 40);
  command_t reset{};
  reset.to = "*";
  reset.verb = "reset";
  reset.sensor_a = "s";
  reset.sensor_b = sensor(0);
  others_.publish(bus::command_channel, reset);
  send(40, 50, 1);
  run(200ms);
  for (int k = 1; k < pairs; ++k) EXPECT_EQ(sent_[k].back().problem.seq, 49) << k;
}

}  // namespace
}  // namespace egocal::services::test_early_choices
