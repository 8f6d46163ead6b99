// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What all stages of the pairing together decide.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/corruption.hpp"
#include "../support/pairing_stages.hpp"
#include "../support/random_motion.hpp"
#include "egocal/error.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::test_pairing_stages {
namespace {

using testing::Corruption;
using testing::displacement;
using testing::rejected;
using testing::simulated;
using testing::Streams;

TEST(PairingOptions, OutOfTheirRangeAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = HUGE_VAL;
  const auto refused = [](const PairingOptions& options, const std::string& name) {
    try {
      MotionPairing{options};
    } catch (const Error& error) {
      return std::string(error.what()).find(name) != std::string::npos;
    }
    return false;
  };
  for (const double value : {nan, infinity, -infinity, 1e300, 0.0, -1.0}) {
    EXPECT_TRUE(refused({.max_gap = value}, "max_gap")) << value;
    if (value == 0.0 || value == -1.0) continue;
    EXPECT_TRUE(refused({.time_offset = value}, "time_offset")) << value;
  }
  EXPECT_TRUE(refused({.stride = 0}, "stride"));
  EXPECT_TRUE(refused({.stride = 1'000'000'000}, "stride"));
  EXPECT_TRUE(refused({.balance = Balance{-1, 1}}, "rotation weight"));
  EXPECT_TRUE(refused({.balance = Balance{1, 0}}, "translation weight"));
  EXPECT_TRUE(refused({.balance = Balance{1, nan}}, "translation weight"));
  PairingOptions options;
  options.screening.congruence.longest_lever_arm = nan;
  EXPECT_TRUE(refused(options, "longest_lever_arm"));
  options = {};
  options.clock.phase = 1;  // a whole delay later: as late as the next pair of the rig
  EXPECT_TRUE(refused(options, "clock.phase"));
  options = {};
  options.accumulator.choice_phase = 1;
  EXPECT_TRUE(refused(options, "choice_phase"));
  options = {};
  options.accumulator.balances = {};
  EXPECT_TRUE(refused(options, "balances"));
}

/// Extreme stamps, positions and everything else that is no pose are counted, and move nothing.
TEST(MotionPairing, PosesBeyondTheLimitsAreCountedAndIgnored) {
  const Streams data = simulated(200);
  MotionPairing drive{PairingOptions{}};
  const MotionPairing clean = pair_motions({}, data.a, data.b).drive;
  std::uint64_t bad = 0;
  for (std::size_t i = 0; i < data.a.size(); ++i) {
    for (const std::int64_t time :
         {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max(),
          std::int64_t{-9'000'000'000'000'000'000}}) {
      drive.push(Side::a, {time, data.a[i].pose});
      ++bad;
    }
    StampedPose far = data.b[i];
    far.pose = displacement({0, 0, 0}, {1e12, 0, 0});
    drive.push(Side::b, far);
    ++bad;
    drive.push(Side::a, data.a[i]);
    drive.push(Side::b, data.b[i]);
  }
  drive.finish();
  EXPECT_EQ(drive.counts().rejected[static_cast<std::size_t>(Rejection::not_finite)], bad);
  EXPECT_EQ(cost_matrix(drive.problem()), cost_matrix(clean.problem()));
}

/// Which instants are believed, in which chain, of drives with every kind of corruption. Whole numbers only:
/// they are the same on every machine. Values of the first version, whose statistics the stages kept bit by
/// bit on 122 drives.
TEST(MotionPairing, BelievesWhatTheFirstVersionBelieved) {
  std::uint64_t hash = 1469598103934665603u;
  const auto mix = [&hash](std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) hash = (hash ^ ((value >> (8 * byte)) & 0xff)) * 1099511628211u;
  };
  for (const Corruption corruption : testing::corruptions) {
    const Streams data = simulated(1000, 0.01, 5);
    const Trajectory b = testing::corrupted(data.b, corruption, 6);
    Synchroniser synchroniser{PairingOptions{}};
    Screening screening{ScreeningOptions{}};
    std::vector<Instant> accepted;
    const auto take = [&](const std::vector<Instant>& instants) {
      for (const Instant& instant : instants) {
        const Screened screened = screening.push(instant, synchroniser.period_us());
        if (screened.replaces) accepted.clear();
        accepted.insert(accepted.end(), screened.accepted.begin(), screened.accepted.end());
      }
    };
    for (const StampedPose& pose : data.a) take(synchroniser.push(Side::a, pose));
    for (const StampedPose& pose : b) take(synchroniser.push(Side::b, pose));
    take(synchroniser.finish());
    screening.finish();
    for (const Instant& instant : accepted) {
      mix(static_cast<std::uint64_t>(instant.time_us));
      mix(instant.chain);
    }
    for (const Rejections* stage : {&synchroniser.state().rejections, &screening.state().rejections})
      for (const std::uint64_t count : stage->by_reason) mix(count);
    mix(accepted.size());
  }
  EXPECT_EQ(hash, 12234235260429120617u);
}

}  // namespace
}  // namespace egocal::test_pairing_stages
