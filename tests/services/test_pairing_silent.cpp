// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A log that ends shortly after the clocks were compared for the first time: the poses that were held back
// until then count all the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/rig.hpp"
#include "pairing/pairing.hpp"
#include "support/scratch_folder.hpp"
#include "support/simulated_drive.hpp"
#include "support/virtual_time.hpp"

namespace egocal::services::test_pairing_silent {
namespace {

using namespace std::chrono_literals;

class SilentPairing : public ::testing::Test {
 protected:
  static constexpr int rate = 50;  ///< [Hz]: the first estimate comes into force after 12 s

  explicit SilentPairing(std::unique_ptr<SavedState> saved = nullptr)
      : network_(clock_),
        loop_(network_.transport(), clock_, {.handle_signals = false}),
        others_(network_.transport(), clock_, {.handle_signals = false}),
        heartbeat_(loop_, {"egocal-pairing", bus::Role::pairing, "1.0", 1}, 3s),
        pairing_(loop_, heartbeat_, rig(), std::move(saved)) {
    others_.subscribe<problem_t>(
        bus::problem_channel("a", "b"),
        [this](const problem_t& problem, const bus::Arrival&) { newest_ = problem; });
    others_.subscribe<motion_pair_t>(bus::motion_channel("a", "b"),
                                     [this](const motion_pair_t&, const bus::Arrival&) { ++motions_; });
    others_.subscribe<status_t>(bus::status_channel, [this](const status_t& status, const bus::Arrival&) {
      last_error_ = status.last_error;
    });
  }

  static bus::Rig rig() {
    return bus::parse_rig(
        "[[sensor]]\nname = \"a\"\nchannel = \"A\"\n[[sensor]]\nname = \"b\"\nchannel = \"B\"\n"
        "[[pair]]\na = \"a\"\nb = \"b\"\ntime_offset = \"auto\"\n",
        "rig.toml");
  }

  static testing::Streams drive(double seconds) {
    return testing::simulated_drive({.terrain = Terrain::free,
                                     .poses = static_cast<int>(rate * seconds),
                                     .rate = rate,
                                     .speed = 2,
                                     .relative_noise = 0.01,
                                     .seed = 4});
  }

  /// Poses [from, to) of both streams, each after `period`.
  void send(const testing::Streams& streams, std::size_t from, std::size_t to,
            std::chrono::milliseconds period) {
    for (std::size_t i = from; i < to; ++i) {
      const auto number = static_cast<std::int64_t>(i);
      others_.publish_bytes("A", bus::encode(bus::to_message(streams.a[i], number)));
      others_.publish_bytes("B", bus::encode(bus::to_message(streams.b[i], number)));
      test::run_for(clock_, {&loop_, &others_}, period);
    }
  }
  void stay_silent() { test::run_for(clock_, {&loop_, &others_}, 3s); }

  test::VirtualClock clock_;
  test::VirtualNetwork network_;
  bus::Loop loop_, others_;
  bus::Heartbeat heartbeat_;
  Pairing pairing_;
  problem_t newest_{};
  int motions_ = 0;
  std::string last_error_;
};

TEST_F(SilentPairing, WhatWasHeldBackAtTheEndOfALogCounts) {
  const testing::Streams streams = drive(12.5);
  send(streams, 0, streams.a.size(), 20ms);
  EXPECT_LT(newest_.seq, 400);
  stay_silent();
  EXPECT_GE(newest_.seq, static_cast<std::int64_t>(streams.a.size()) - 10);
  EXPECT_EQ(newest_.seq, motions_);
}

// It ended without a motion and without a word. `egocal up` waits for 1.5 s after its log.
TEST_F(SilentPairing, AnEndBeforeTheClocksAreComparedIsReported) {
  const testing::Streams streams = drive(14);
  const std::size_t end = 9 * rate;
  send(streams, 0, end, 20ms);
  EXPECT_EQ(last_error_, "");
  test::run_for(clock_, {&loop_, &others_}, 1s);
  EXPECT_EQ(last_error_,
            "a -> b: no motion yet, as time_offset = \"auto\" compares the clocks after 12 s or more of both "
            "streams; a shorter drive: egocal solve --time-offset auto");
  EXPECT_EQ(motions_, 0);
  send(streams, end, end + 50, 20ms);
  EXPECT_EQ(last_error_, "") << "the drive goes on";
  send(streams, end + 50, streams.a.size(), 20ms);
  stay_silent();
  EXPECT_EQ(last_error_, "");
  EXPECT_GE(newest_.seq, static_cast<std::int64_t>(streams.a.size()) - 10);
}

// The state with the offset of the clocks was refused: one error hid the other.
struct Folder {
  testing::ScratchFolder folder;
};
class WithRefusedState : Folder, public SilentPairing {
 protected:
  WithRefusedState() : SilentPairing(refused(folder.path("pairing.state"))) {}

  static std::unique_ptr<SavedState> refused(const std::string& file) {
    bus::Rig other = rig();
    other.pairs[0].stride = 7;
    SavedState(file, other).restore();
    return std::make_unique<SavedState>(file, rig());
  }
};

TEST_F(WithRefusedState, BothAreReported) {
  send(drive(9), 0, 9 * rate, 20ms);
  stay_silent();
  EXPECT_THAT(last_error_, ::testing::StartsWith("a -> b: no motion yet, as time_offset"));
  EXPECT_THAT(last_error_, ::testing::HasSubstr("; "));
  EXPECT_THAT(last_error_, ::testing::HasSubstr("another rig or version"));
}

// Played so slowly that there is a silence after each pose.
TEST_F(SilentPairing, TheSpeedChangesNothing) {
  const testing::Streams streams = drive(14);
  const std::size_t held = 12 * rate;
  send(streams, 0, held, 20ms);
  send(streams, held, streams.a.size(), 700ms);
  stay_silent();
  const problem_t slow = newest_;
  MotionPairing expected(bus::drive_options(rig(), rig().pairs[0]));
  for (std::size_t i = 0; i < streams.a.size(); ++i) {
    expected.push(Side::a, streams.a[i]);
    expected.push(Side::b, streams.b[i]);
  }
  expected.release_held();
  ASSERT_GT(slow.seq, 400);
  EXPECT_EQ(slow.matched, static_cast<std::int64_t>(expected.counts().matched));
  const bus::Checked<Problem> problem = bus::to_problem(slow);
  ASSERT_TRUE(problem.value);
  // poses that went over the bus are rounded
  EXPECT_TRUE(sum_blocks(problem.value->blocks)
                  .dual_rows.isApprox(sum_blocks(expected.problem().blocks).dual_rows, 1e-9));
}

}  // namespace
}  // namespace egocal::services::test_pairing_silent
