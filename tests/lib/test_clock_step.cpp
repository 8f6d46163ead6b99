// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A clock that was set in mid-drive is no mounting that moved.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_clock_step {
namespace {

using testing::drive;
using testing::find;

/// From a part of the drive on, stamps are later by `seconds`.
Trajectory set_later(Trajectory trajectory, double part, double seconds) {
  const auto first = static_cast<std::size_t>(part * static_cast<double>(trajectory.size()));
  for (std::size_t i = first; i < trajectory.size(); ++i)
    trajectory[i].time_us += std::llround(1e6 * seconds);
  return trajectory;
}

TEST(ClockStep, IsNamedWithItsTimeItsSizeAndItsStream) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const Side side : {Side::a, Side::b})
      for (const double seconds : {0.3, 2.0}) {
        testing::Streams streams = drive(terrain, 3);
        Trajectory& wrong = side == Side::a ? streams.a : streams.b;
        wrong = set_later(wrong, 0.5, seconds);
        const Calibration calibration = calibrate(streams.a, streams.b);
        const Finding* step = find(calibration, "clock_step");
        ASSERT_NE(step, nullptr) << seconds << ": " << calibration.reason;
        EXPECT_TRUE(step->certain) << step->message;
        ASSERT_TRUE(step->time && step->value && step->T_a_b);
        EXPECT_NEAR(*step->time, 30, 0.2) << step->message;
        EXPECT_NEAR(*step->value, side == Side::a ? seconds : -seconds, 0.02);
        EXPECT_NE(step->message.find(side == Side::a ? "The stamps of a" : "The stamps of b"),
                  std::string::npos)
            << step->message;
        EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*step->T_a_b)).rotation, 0.01);
        EXPECT_EQ(find(calibration, "mount_moved"), nullptr);
        EXPECT_EQ(find(calibration, "unrelated"), nullptr);
      }
}

/// Where nothing else is found: one half explains the other one's turns as outliers.
TEST(ClockStep, IsNamedAtAConstantSpeed) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SimulationOptions options;
    options.poses = 601;
    options.relative_noise = 0.01;
    options.seed = seed;
    testing::Streams streams = testing::simulated_drive(options);
    streams.b = set_later(streams.b, 0.5, 0.3);
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Finding* step = find(calibration, "clock_step");
    ASSERT_NE(step, nullptr) << seed << ": " << calibration.reason;
    EXPECT_NEAR(*step->value, -0.3, 0.02);
    EXPECT_GE(calibration.verdict, Verdict::doubtful);
  }
}

TEST(ClockStep, IsNoneOfAMountingThatWasKnocked) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const double size : {0.03, 0.1}) {
      testing::Streams streams = drive(terrain, 3);
      streams.b = testing::knocked(streams.b, 0.5, {rotation_exp({0, size, size}), {size, 0, 0}});
      const Calibration calibration = calibrate(streams.a, streams.b);
      EXPECT_NE(find(calibration, "mount_moved"), nullptr) << size << ": " << calibration.reason;
      const Finding* step = find(calibration, "clock_step");
      EXPECT_TRUE(step == nullptr || !step->certain) << step->message;
    }
}

}  // namespace
}  // namespace egocal::test_clock_step
