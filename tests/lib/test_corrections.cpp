// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// An odometry that closes a loop draws its poses to where they belong for some seconds: no mount moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/shaken_car.hpp"
#include "diagnosis/motions/correction.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_corrections {
namespace {

using testing::find;

/// A car whose sensors know their poses as SLAM does: with an error that does not add up.
testing::Streams with_known_poses(std::uint64_t seed) {
  testing::ShakenCar car;
  car.seed = seed;
  car.seconds = 50;
  car.rate_a = car.rate_b = 20;
  car.phase_b = 0;
  car.noise_angle = car.noise_step = 0;
  testing::Random random(seed + 1000);
  car.size = random.log_uniform(0.002, 0.02);
  const double noise = random.log_uniform(0.5, 5);
  testing::Streams streams = testing::shaken_car(car);
  for (Trajectory* stream : {&streams.a, &streams.b})
    for (StampedPose& stamped : *stream)
      stamped.pose = stamped.pose * to_dual_quaternion({rotation_exp(random.normal3(1e-4 * noise)),
                                                        random.normal3(0.002 * noise)});
  return streams;
}

double seconds_of(const StampedPose& stamped) {
  return 1e-6 * static_cast<double>(stamped.time_us);
}

/// From `begin` on, evenly drawn by a turn about the vertical and a shift, for `seconds`.
Trajectory corrected(Trajectory trajectory, double begin, double seconds, double turn,
                     const Eigen::Vector3d& shift) {
  const Pose at_begin =
      to_pose(std::find_if(trajectory.begin(), trajectory.end(), [&](const StampedPose& stamped) {
                return seconds_of(stamped) >= begin;
              })->pose);
  for (StampedPose& stamped : trajectory) {
    const double part = std::clamp((seconds_of(stamped) - begin) / seconds, 0.0, 1.0);
    const double smooth = part * part * (3 - 2 * part);
    const Pose about{Rotation::Identity(), at_begin.translation};
    const Pose change{rotation_exp({0, 0, smooth * turn}), smooth * shift};
    stamped.pose = to_dual_quaternion(about * change * inverse(about)) * stamped.pose;
  }
  return trajectory;
}

TEST(Correction, IsNoMoveOfTheMount) {
  int moved = 0;
  // of 160 drives the first five were called moved
  constexpr std::uint64_t seeds[] = {10, 82, 93, 103, 136, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12};
  for (const std::uint64_t seed : seeds) {
    testing::Streams streams = with_known_poses(seed);
    testing::Random random(seed);
    const double begin = random.uniform(8, 36), size = random.log_uniform(0.3, 50);
    Eigen::Vector3d shift = random.direction();
    shift.z() *= 0.1;
    streams.b = corrected(streams.b, begin, 5, random.normal() * 0.05, size * shift);
    const Calibration calibration = calibrate(streams.a, streams.b);
    moved += find(calibration, "mount_moved") != nullptr;
    const ExtrinsicError error = extrinsic_error(streams.T, to_dual_quaternion(calibration.T_a_b));
    EXPECT_LT(error.rotation, 0.015) << seed;
  }
  std::printf("of %zu corrections %d look like a mount that moved\n", std::size(seeds), moved);
  EXPECT_LE(moved, 1);
}

TEST(Correction, IsNoneWhereTheMountMoved) {
  int moved = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    testing::Streams streams = with_known_poses(seed);
    streams.b = testing::knocked(streams.b, 0.5, {rotation_exp({0, 0.03, 0}), {0, 0.05, 0}});
    moved += find(calibrate(streams.a, streams.b), "mount_moved") != nullptr;
  }
  EXPECT_EQ(moved, 8);
}

}  // namespace
}  // namespace egocal::test_corrections
