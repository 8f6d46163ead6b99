// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A head that turns about a point near both sensors: their positions change by noise alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "../support/findings.hpp"
#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_travel_in_noise {
namespace {

using testing::displacement;

/// A minute at 10 Hz. noise: of the positions of b [m]; a measures well.
testing::Streams head(std::uint64_t seed, double lever, double noise) {
  testing::Random random(seed);
  const DualQuaternion T_a = displacement({0.1, 0.2, -0.3}, {lever, 0, 0.5 * lever}),
                       T_b = displacement({-0.4, 0.3, 1}, {0, lever, -0.5 * lever});
  testing::Streams streams;
  streams.T = conjugate(T_a) * T_b;
  for (int i = 0; i <= 600; ++i) {
    const double t = 0.1 * i;
    const DualQuaternion turned =
        displacement({0, 0, std::sin(0.9 * t) + 0.5 * std::sin(2.3 * t)}, {0, 0, 0}) *
        displacement({0, 0.6 * std::sin(1.3 * t), 0}, {0, 0, 0}) *
        displacement({0.4 * std::sin(0.7 * t), 0, 0}, {0, 0, 0});
    const auto time_us = std::int64_t{100'000} * i;
    const auto measured = [&](const DualQuaternion& T, double of_position) {
      Pose pose = to_pose(turned * T * displacement(random.normal3(0.001), {0, 0, 0}));
      pose.translation += random.normal3(of_position);
      return canonical_sign(to_dual_quaternion(pose));
    };
    streams.a.push_back({time_us, measured(T_a, 1e-4)});
    streams.b.push_back({time_us, measured(T_b, noise)});
  }
  return streams;
}

TEST(TravelInNoise, DoesNotContradictTheAnswer) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const testing::Streams streams = head(seed, 0.002, 0.01);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << calibration.reason;
    const Eigen::Vector3d off = calibration.minimum.translation - to_pose(streams.T).translation;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT(std::abs(off[static_cast<Eigen::Index>(i)]), 4 * calibration.observability.stddev[i]) << seed;
  }
}

// A vehicle's b that has no positions but noise is another thing: a travels.
TEST(TravelInNoise, PositionsOfNoiseBesideATravellingSensorContradict) {
  testing::Streams streams = testing::drive(Terrain::free);
  testing::Random random(3);
  for (StampedPose& pose : streams.b) {
    Pose here = to_pose(pose.pose);
    here.translation = random.normal3(0.02);
    pose.pose = canonical_sign(to_dual_quaternion(here));
  }
  EXPECT_EQ(calibrate(streams.a, streams.b).verdict, Verdict::contradictory);
}

}  // namespace
}  // namespace egocal::test_travel_in_noise
