// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Few digits beside a mounting that exchanges axes exactly: most numbers of both files are rounded alike.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "../support/simulated_drive.hpp"
#include "calibration/rounded_streams.hpp"
#include "diagnosis/streams/written_digits.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::test_rounded_alike {
namespace {

enum class As { quaternions, matrices };

Trajectory written_as(As kind, Trajectory poses, int decimals) {
  const double step = std::pow(10, -decimals);
  const auto write = [step](double x) { return step * std::round(x / step); };
  for (StampedPose& stamped : poses) {
    Pose pose = to_pose(stamped.pose);
    if (kind == As::quaternions)
      pose.rotation.coeffs() = pose.rotation.coeffs().unaryExpr(write).eval();
    else
      pose.rotation = Rotation(Eigen::Matrix3d(pose.rotation.toRotationMatrix().unaryExpr(write)));
    pose.rotation.normalize();
    pose.translation = pose.translation.unaryExpr(write).eval();
    stamped.pose = canonical_sign(to_dual_quaternion(pose));
  }
  return poses;
}

/// A camera looks along the road: its z is the vehicle's x, its x points to the right.
const Pose T_vehicle_camera{Rotation(0.5, -0.5, 0.5, -0.5), {0.37, -0.21, 0.6}};

testing::Streams camera_on_a_lidar(double noise, std::uint64_t seed) {
  SimulationOptions options;
  options.terrain = Terrain::rough;
  options.poses = 401;
  options.relative_noise = noise;
  options.seed = seed;
  options.T_vehicle_sensor = {Pose{}, T_vehicle_camera};
  std::vector<Trajectory> both = simulate(options);
  return {to_dual_quaternion(T_vehicle_camera), std::move(both[0]), std::move(both[1]), {}};
}

double rejected_part(const PairingCounts& counts) {
  return static_cast<double>(counts.rejected[static_cast<std::size_t>(Rejection::screw_congruence)]) /
         static_cast<double>(counts.synchronised);
}

TEST(RoundedAlike, DigitsOfMatricesAreFound) {
  const Trajectory a = camera_on_a_lidar(0.002, 1).a;
  for (const int decimals : {2, 3, 4, 6}) {
    EXPECT_EQ(detail::digits_of_matrices(written_as(As::matrices, a, decimals)).decimals, decimals);
    EXPECT_FALSE(detail::digits_of_matrices(written_as(As::quaternions, a, decimals)).known()) << decimals;
    EXPECT_FALSE(detail::written(written_as(As::matrices, a, decimals)).rotation.known()) << decimals;
  }
  EXPECT_FALSE(detail::digits_of_matrices(a).known());
}

/// On a nearly straight drive the scalar part is 1.000 in each row, and the others have one digit: 0.004.
TEST(RoundedAlike, OneIsNoNumberOfOneDigit) {
  Trajectory straight;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.1 * i;
    const Eigen::Vector3d turn{0.008 * std::sin(t), 0.006 * std::cos(0.7 * t), 0.015 * std::sin(0.3 * t)};
    straight.push_back({i * 100'000, to_dual_quaternion(Pose{rotation_exp(turn), {t, 0.1 * t, 0}})});
  }
  const detail::Digits by_decimals = detail::written(written_as(As::quaternions, straight, 3)).rotation;
  EXPECT_EQ(by_decimals.decimals, 3);
  EXPECT_EQ(by_decimals.significant, 0);
  EXPECT_NEAR(by_decimals.step(1), 1e-3, 1e-15);

  const auto two_digits = [](double x) {
    if (x == 0) return x;
    const double step = std::pow(10, std::floor(std::log10(std::abs(x))) - 1);
    return step * std::round(x / step);
  };
  for (StampedPose& stamped : straight) {
    Pose pose = to_pose(stamped.pose);
    pose.rotation.coeffs() = pose.rotation.coeffs().unaryExpr(two_digits).eval();
    pose.rotation.normalize();
    stamped.pose = canonical_sign(to_dual_quaternion(pose));
  }
  EXPECT_EQ(detail::written(straight).rotation.significant, 2);
}

/// By the differences between the streams alone some of these drives lose more than half of their poses.
TEST(RoundedAlike, MostPosesAreKept) {
  double most_without = 0;
  for (const As kind : {As::quaternions, As::matrices})
    for (const int decimals : {3, 4})
      for (const double noise : {0.0, 0.002})
        for (std::uint64_t seed = 1; seed <= 2; ++seed) {
          const testing::Streams drive = camera_on_a_lidar(noise, seed);
          const Trajectory a = written_as(kind, drive.a, decimals), b = written_as(kind, drive.b, decimals);
          const double without = rejected_part(paired({}, a, b).counts()),
                       with = rejected_part(paired(detail::with_rounding({}, a, b), a, b).counts());
          EXPECT_LT(with, 0.05) << decimals << " decimals, noise " << noise << ", seed " << seed;
          most_without = std::max(most_without, without);
        }
  EXPECT_GT(most_without, 0.5);
}

TEST(RoundedAlike, ACalibrationKnowsOfIt) {
  const testing::Streams drive = camera_on_a_lidar(0.0005, 1);
  const Calibration done =
      calibrate(written_as(As::quaternions, drive.a, 3), written_as(As::quaternions, drive.b, 3), {});
  EXPECT_LT(rejected_part(done.counts), 0.05);
  EXPECT_EQ(done.verdict, Verdict::good) << done.reason;
}

/// A twentieth of the poses of b is off by 3 degrees and 0.3 m: far more than what three decimals make.
TEST(RoundedAlike, WrongPosesAreStillRejected) {
  for (const As kind : {As::quaternions, As::matrices}) {
    testing::Streams drive = camera_on_a_lidar(0.0005, 4);
    std::mt19937 random(5);
    std::size_t wrong = 0;
    for (StampedPose& stamped : drive.b) {
      if (random() % 20 != 0) continue;
      const Pose off{rotation_exp({0.05, -0.01, 0.01}), {0.3, 0, 0}};
      stamped.pose = stamped.pose * to_dual_quaternion(off);
      ++wrong;
    }
    const Trajectory a = written_as(kind, drive.a, 3), b = written_as(kind, drive.b, 3);
    const MotionPairing pairing = paired(detail::with_rounding({}, a, b), a, b);
    const PairingCounts& counts = pairing.counts();
    EXPECT_GE(counts.rejected[static_cast<std::size_t>(Rejection::screw_congruence)], wrong * 9 / 10);
    EXPECT_LT(rejected_part(counts), 0.08);
  }
}

TEST(RoundedAlike, StreamsWithAllDigitsKeepTheirFloors) {
  const testing::Streams drive = camera_on_a_lidar(0.0005, 1);
  const CongruenceOptions before, after = detail::with_rounding({}, drive.a, drive.b).screening.congruence;
  EXPECT_EQ(after.angle_floor, before.angle_floor);
  EXPECT_EQ(after.length_floor, before.length_floor);
}

}  // namespace
}  // namespace egocal::test_rounded_alike
