// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses on lines between measured ones: whatever moved the sensor there is lost.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "../support/bounded_drive.hpp"
#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_interpolated_streams {
namespace {

using testing::bounded_drive;
using testing::find;

/// Whatever moved the sensor between the poses that were measured is lost.
TEST(InterpolatedStreams, AStreamThatWasInterpolatedIsNamed) {
  testing::Streams streams = bounded_drive();
  streams.b = testing::interpolated(streams.b, 10);
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* finding = find(calibration, "undersampled_b");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_NE(finding->message.find("between about 1.0 poses a second"), std::string::npos) << finding->message;
  EXPECT_EQ(find(calibration, "undersampled_a"), nullptr);
}

TEST(InterpolatedStreams, PositionsAloneThatWereInterpolatedAreNamed) {
  testing::Streams streams = bounded_drive();
  const Trajectory lines = testing::interpolated(streams.a, 10);
  for (std::size_t i = 0; i < streams.a.size(); ++i) {
    Pose pose = to_pose(streams.a[i].pose);
    pose.translation = to_pose(lines[i].pose).translation;
    streams.a[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* finding = find(calibration, "undersampled_a");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_NE(finding->message.find("between about 1.0 positions a second"), std::string::npos)
      << finding->message;
}

/// A smooth stream in little noise is nearly straight everywhere, and has no corners (100 Hz, 3 m/s).
TEST(InterpolatedStreams, ASmoothStreamBesideANoisyOneIsNoInterpolation) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SimulationOptions simulation;
    simulation.terrain = Terrain::flat;
    simulation.poses = 3000;
    simulation.rate = 100;
    simulation.speed = 3;
    simulation.speed_variation = 0.5;
    simulation.relative_noise = 0.001;
    simulation.seed = seed;
    simulation.faults.resize(2);
    simulation.faults[1].noise_factor = 5;
    const testing::Streams streams = testing::simulated_drive(simulation);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(find(calibration, "undersampled_a"), nullptr) << seed;
  }
}

/// Straight lines that both sensors drive are no interpolation.
TEST(InterpolatedStreams, SteadyMotionIsNoInterpolation) {
  testing::Streams streams;
  const Pose T{rotation_exp({0.2, -0.1, 0.4}), {0.3, 0.2, -0.1}};
  for (int i = 0; i < 600; ++i) {
    const double t = 0.1 * i,
                 turn = 0.4 * std::floor(t / 5) + (std::fmod(t, 10) < 5 ? 0 : 0.4 * (std::fmod(t, 5) / 5));
    const Pose rig{rotation_exp({0.3 * turn, 0.1 * turn, turn}), {t, 0.2 * t, 0}};
    const auto time_us = static_cast<std::int64_t>(i) * 100'000;
    streams.a.push_back({time_us, canonical_sign(to_dual_quaternion(rig))});
    streams.b.push_back({time_us, canonical_sign(to_dual_quaternion(rig * T))});
  }
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(find(calibration, "undersampled_a"), nullptr);
  EXPECT_EQ(find(calibration, "undersampled_b"), nullptr);
}

}  // namespace
}  // namespace egocal::test_interpolated_streams
