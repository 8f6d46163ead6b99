// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses that waited in a buffer have the stamps of their arrival, several at once, and are named. Poses that
// a sensor really measures in bursts are not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "diagnosis/streams/stamps_in_bursts.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_stamps_in_bursts {
namespace {

using testing::buffered;
using testing::drive;
using testing::find;

TEST(StampsInBursts, AreNamedWithTheirStream) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free})
    for (const std::size_t count : {2u, 3u, 5u}) {
      const testing::Streams streams = drive(terrain);
      const Calibration calibration = calibrate(streams.a, buffered(streams.b, count));
      const Finding* finding = find(calibration, "stamps_b");
      ASSERT_NE(finding, nullptr) << count << ": " << calibration.reason;
      EXPECT_TRUE(finding->certain);
      EXPECT_EQ(find(calibration, "stamps_a"), nullptr);
      EXPECT_GE(calibration.verdict, Verdict::doubtful);
    }
}

TEST(StampsInBursts, AreNamedOfAStreamThatNeverTurns) {
  Trajectory shuttle;
  for (int i = 0; i < 400; ++i)
    shuttle.push_back({100'000 * i, testing::displacement({0, 0, 0}, {2 * std::sin(0.05 * i), 0.3 * i, 0})});
  EXPECT_EQ(detail::motion_in_bursts(shuttle), 0);
  EXPECT_NEAR(detail::motion_in_bursts(buffered(shuttle, 3)), 1, 0.05);
  for (StampedPose& pose : shuttle) pose.pose = testing::displacement({0, 0, 0}, {0, 0, 0});
  EXPECT_EQ(detail::motion_in_bursts(buffered(shuttle, 3)), 0) << "what stands still shows nothing";
}

TEST(StampsInBursts, OfBothStreamsAreNamedBoth) {
  const testing::Streams streams = drive(Terrain::free);
  const Calibration calibration = calibrate(buffered(streams.a, 4), buffered(streams.b, 4));
  EXPECT_TRUE(find(calibration, "stamps_a") && find(calibration, "stamps_b")) << calibration.reason;
}

/// Two poses a millisecond apart, five times a second, with noise of each pose that is larger than what lies
/// between them.
TEST(StampsInBursts, AreNoneWhereTheSensorMeasuresSo) {
  testing::Random random(1);
  Trajectory trajectory;
  for (int i = 0; i < 600; ++i) {
    const std::int64_t time_us = i / 2 * 200'000 + i % 2 * 1000;
    const double t = 1e-6 * static_cast<double>(time_us);
    trajectory.push_back({time_us, testing::displacement({0.2 * std::sin(t), 0.1 * std::cos(2 * t), 0.3 * t},
                                                         {2 * t, std::sin(0.5 * t), 0.2 * std::cos(t)}) *
                                       testing::displacement(random.normal3(0.003), random.normal3(0.02))});
  }
  EXPECT_LT(detail::motion_in_bursts(trajectory), 0.3);
}

TEST(StampsInBursts, AreNoneOfPosesThatAreLost) {
  testing::Random random(2);
  testing::Streams streams = drive(Terrain::free);
  std::erase_if(streams.b, [&](const StampedPose&) { return random.uniform() < 0.6; });
  EXPECT_EQ(detail::motion_in_bursts(streams.b), 0);
}

/// The recording was paused while the vehicle stood: the steps before and after are shorter than the mean.
TEST(StampsInBursts, AreNoneOfPauses) {
  testing::Streams streams = drive(Terrain::free);
  const auto pause = [](Trajectory& trajectory) {
    for (std::size_t i = 0; i < trajectory.size(); ++i)
      trajectory[i].time_us += static_cast<std::int64_t>(i / 100) * 200'000'000;
  };
  pause(streams.a);
  pause(streams.b);
  EXPECT_EQ(detail::motion_in_bursts(streams.a), 0);
  EXPECT_EQ(find(calibrate(streams.a, streams.b), "stamps_a"), nullptr);
}

/// Poses each half metre, at 12 and at 1 m/s in turn.
TEST(StampsInBursts, AreNoneOfKeyframesByDistance) {
  Trajectory keyframes;
  std::int64_t time_us = 0;
  for (int i = 0; i < 2000; ++i) {
    const double x = 0.5 * i;
    keyframes.push_back({time_us, testing::displacement({0, 0, 0.01 * x}, {x, 0.2 * std::sin(0.1 * x), 0})});
    time_us += i / 400 % 2 == 0 ? 42'000 : 500'000;
  }
  EXPECT_EQ(detail::motion_in_bursts(keyframes), 0);
}

}  // namespace
}  // namespace egocal::test_stamps_in_bursts
