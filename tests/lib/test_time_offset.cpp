// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"

namespace egocal {
namespace {

using testing::Streams;

/// Free motion at 50 Hz; b thinned to 10 Hz, so that the stamps never help.
Streams simulated(double noise, std::uint64_t seed, int seconds = 120) {
  Streams streams = testing::simulated_drive({.terrain = Terrain::free,
                                              .poses = 50 * seconds,
                                              .rate = 50,
                                              .speed = 2,
                                              .relative_noise = noise,
                                              .seed = seed});
  Trajectory b;
  for (std::size_t i = 2; i < streams.b.size(); i += 5) b.push_back(streams.b[i]);
  streams.b = std::move(b);
  return streams;
}

Trajectory shifted(Trajectory path, double seconds) {
  for (StampedPose& pose : path) pose.time_us += std::llround(seconds * 1e6);
  return path;
}

Trajectory thinned(const Trajectory& path, double part, std::uint64_t seed) {
  testing::Random random(seed);
  Trajectory result;
  for (const StampedPose& pose : path)
    if (random.uniform() >= part) result.push_back(pose);
  return result;
}

TEST(TimeOffset, IsFoundWhateverItIsAndItsDeviationTellsTheError) {
  int outside = 0, runs = 0;
  for (const double noise : {0.001, 0.02})
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
      for (const double shift : {-300.0, -0.037, 12.34, 300.0}) {
        const Streams data = simulated(noise, seed, 60);
        const auto offset = estimate_time_offset(data.a, thinned(shifted(data.b, shift), 0.3, seed));
        ASSERT_TRUE(offset);
        EXPECT_NEAR(offset->seconds, -shift, 0.005) << noise << " " << seed;
        EXPECT_GT(offset->correlation, 0.8);
        EXPECT_LT(offset->stddev, 0.005);
        outside += std::abs(offset->seconds + shift) > 3 * offset->stddev + 2e-4;
        ++runs;
      }
  EXPECT_LE(outside, runs / 10) << "of " << runs;
}

TEST(TimeOffset, OfStreamsThatNeverTurnOrAreTooShortIsNotGuessed) {
  const Streams data = simulated(0.001, 1, 20);
  EXPECT_FALSE(estimate_time_offset({}, data.b));
  EXPECT_FALSE(estimate_time_offset(data.a, Trajectory(data.b.begin(), data.b.begin() + 9)));
  Trajectory still = data.b;
  for (StampedPose& pose : still) pose.pose = {};
  const auto offset = estimate_time_offset(data.a, still);
  EXPECT_TRUE(!offset || offset->correlation < 0.5 || !(offset->stddev < 0.005));
}

MotionPairing followed(const Trajectory& a, const Trajectory& b, std::uint64_t interleave,
                       bool drift_seen = false) {
  testing::Random random(interleave);
  PairingOptions options;
  options.track_time_offset = true;
  MotionPairing drive(options);
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const std::uint64_t run = interleave == 0 ? 1 : 1 + random.below(200);
    for (std::uint64_t k = 0; k < run; ++k) {
      // by what has gone by since each began
      const bool from_a =
          j == b.size() || (i < a.size() && a[i].time_us - a[0].time_us <= b[j].time_us - b[0].time_us);
      if (from_a && i < a.size()) drive.push(Side::a, a[i++]);
      if (!from_a && j < b.size()) drive.push(Side::b, b[j++]);
    }
    for (std::uint64_t k = 0; interleave != 0 && k < random.below(100) && i < a.size(); ++k)
      drive.push(Side::a, a[i++]);
  }
  drive.finish();
  EXPECT_EQ(drive.state().clock.changes > 1, drift_seen);
  return drive;
}

TEST(ClockOffset, IsFoundOnTheWayAndCostsNoPose) {
  const Streams data = simulated(0.01, 3);
  const MotionPairing together = pair_motions({}, data.a, data.b).drive;
  for (const double shift : {0.0, -250.0, 1e6}) {
    const MotionPairing drive = followed(data.a, shifted(data.b, shift), 0);
    ASSERT_TRUE(drive.time_offset());
    EXPECT_NEAR(*drive.time_offset(), -shift, 0.005);
    EXPECT_EQ(drive.counts().synchronised, together.counts().synchronised);
    const ExtrinsicError error = extrinsic_error(data.T, solve(drive.problem(), Method::dual).T_a_b);
    const ExtrinsicError best = extrinsic_error(data.T, solve(together.problem(), Method::dual).T_a_b);
    EXPECT_LT(error.rotation, 2 * best.rotation + 2e-3);
    EXPECT_LT(error.translation, 2 * best.translation + 0.01);
  }
}

TEST(ClockOffset, DoesNotDependOnHowTheStreamsInterleave) {
  const Streams data = simulated(0.01, 4, 90);
  const Trajectory b = shifted(data.b, 77);
  const MotionPairing expected = followed(data.a, b, 0);
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const MotionPairing drive = followed(data.a, b, seed);
    EXPECT_EQ(drive.time_offset(), expected.time_offset());
    EXPECT_EQ(total(drive.problem().blocks).dual_rows, total(expected.problem().blocks).dual_rows) << seed;
  }
}

TEST(ClockOffset, DriftIsFollowed) {
  const Streams data = simulated(0.005, 5, 240);
  Trajectory drifting = data.b;  // a clock that is slow by two in ten thousand
  for (StampedPose& pose : drifting)
    pose.time_us -= std::llround(2e-4 * static_cast<double>(pose.time_us - data.b[0].time_us));
  const MotionPairing drive = followed(data.a, drifting, 0, true);
  const double end = 2e-4 * 1e-6 * static_cast<double>(data.b.back().time_us - data.b[0].time_us);
  // the newest estimate is of the minute before; another comes into force at five milliseconds
  EXPECT_NEAR(*drive.time_offset(), end, 0.018);
  EXPECT_GT(*drive.time_offset(), 0.02);
}

TEST(ClockOffset, ContinuesFromItsStateBitForBit) {
  const Streams data = simulated(0.01, 6, 60);
  const Trajectory b = shifted(data.b, -5);
  const Problem expected = followed(data.a, b, 0).problem();
  PairingOptions options;
  options.track_time_offset = true;
  MotionPairing drive(options);
  std::size_t i = 0, j = 0;
  while (i < data.a.size() || j < b.size()) {
    if ((i + j) % 500 == 0) drive = MotionPairing(drive.options(), drive.state());
    const bool from_a = j == b.size() || (i < data.a.size() && data.a[i].time_us - data.a[0].time_us <=
                                                                   b[j].time_us - b[0].time_us);
    from_a ? drive.push(Side::a, data.a[i++]) : drive.push(Side::b, b[j++]);
  }
  drive.finish();
  EXPECT_EQ(total(drive.problem().blocks).dual_rows, total(expected.blocks).dual_rows);
}

TEST(ClockOffset, StreamsThatNeverMatchAreHeldBoundedAndCounted) {
  const Streams data = simulated(0.01, 7, 400), other = simulated(0.01, 8, 400);
  PairingOptions options;
  options.track_time_offset = true;
  MotionPairing drive(options);
  std::size_t j = 0;
  for (const StampedPose& pose : data.a) {
    StampedPose still = pose;
    still.pose = {};
    drive.push(Side::a, still);
    while (j < other.b.size() && other.b[j].time_us <= pose.time_us) drive.push(Side::b, other.b[j++]);
    for (const auto& stream : drive.state().clock.streams) ASSERT_LE(stream.window.size(), 181u * 50u);
  }
  EXPECT_FALSE(drive.time_offset());
  EXPECT_EQ(drive.counts().synchronised, 0u);
  EXPECT_GT(drive.counts().rejected[static_cast<std::size_t>(Rejection::no_partner)], 200u * 50u);
}

}  // namespace
}  // namespace egocal
