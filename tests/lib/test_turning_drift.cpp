// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A gyroscope with a bias: headings that drift beside right positions are named; an odometry that is summed
// up with it is not, as its answer is right.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::test_turning_drift {
namespace {

using testing::find;

constexpr double degree = std::numbers::pi / 180;

enum class Positions { right, summed_up };

/// rate: of the bias, in the frame of the sensor [rad/s].
Trajectory with_bias(const Trajectory& right, const Eigen::Vector3d& rate, Positions positions) {
  Trajectory result = right;
  Pose now = to_pose(right.front().pose);
  for (std::size_t i = 1; i < right.size(); ++i) {
    const double seconds = to_seconds(right[i].time_us - right[i - 1].time_us);
    const Pose motion = inverse(to_pose(right[i - 1].pose)) * to_pose(right[i].pose);
    now = now * motion * Pose{rotation_exp(seconds * rate), Eigen::Vector3d::Zero()};
    now.rotation.normalize();
    Pose pose = now;
    if (positions == Positions::right) pose.translation = to_pose(right[i].pose).translation;
    result[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  return result;
}

testing::Streams drive(std::uint64_t seed, double noise = 0.005) {
  SimulationOptions options;
  options.terrain = Terrain::rough;
  options.poses = 601;
  options.relative_noise = noise;
  options.seed = seed;
  return testing::simulated_drive(options);
}

bool names_drift(const Calibration& calibration) {
  return std::any_of(calibration.findings.begin(), calibration.findings.end(),
                     [](const Finding& one) { return one.code.starts_with("turning_drift_"); });
}

TEST(TurningDrift, HeadingsThatDriftBesideRightPositionsAreNamed) {
  for (const Side side : {Side::a, Side::b})
    for (const double rate : {0.1 * degree, 0.5 * degree}) {
      testing::Streams s = drive(2);
      // of the vertical of the vehicle
      const Pose& mount = side == Side::a ? testing::T_vehicle_a : testing::T_vehicle_b;
      const Eigen::Vector3d bias = mount.rotation.conjugate() * Eigen::Vector3d(0, 0, rate);
      Trajectory& wrong = side == Side::a ? s.a : s.b;
      wrong = with_bias(wrong, bias, Positions::right);
      const Calibration calibration = calibrate(s.a, s.b);
      ASSERT_FALSE(calibration.findings.empty()) << rate / degree << ": " << calibration.reason;
      const Finding& finding = calibration.findings.front();
      EXPECT_EQ(finding.code, side == Side::a ? "turning_drift_a" : "turning_drift_b") << finding.message;
      EXPECT_TRUE(finding.certain);
      EXPECT_NEAR(finding.value.value_or(0), rate, 0.1 * rate);
      ASSERT_TRUE(finding.T_a_b);
      EXPECT_LT(extrinsic_error(s.T, to_dual_quaternion(*finding.T_a_b)).rotation, 0.5 * degree);
      EXPECT_EQ(find(calibration, "mount_moved"), nullptr);
      // what it calls good is right
      const double off = extrinsic_error(s.T, to_dual_quaternion(calibration.minimum)).rotation;
      EXPECT_TRUE(calibration.verdict != Verdict::good || off < degree) << off / degree;
    }
}

TEST(TurningDrift, OdometriesThatAreSummedUpWithABiasKeepTheirAnswer) {
  for (const Side side : {Side::a, Side::b}) {
    testing::Streams s = drive(3);
    Trajectory& wrong = side == Side::a ? s.a : s.b;
    wrong = with_bias(wrong, {0, 0.05 * degree, 0.1 * degree}, Positions::summed_up);
    const Calibration calibration = calibrate(s.a, s.b);
    EXPECT_FALSE(names_drift(calibration));
    EXPECT_EQ(calibration.verdict, Verdict::good) << calibration.reason;
    EXPECT_LT(extrinsic_error(s.T, to_dual_quaternion(calibration.minimum)).rotation, degree);
  }
}

TEST(TurningDrift, NoiseAndKnocksAreNotCalledOne) {
  for (const double noise : {0.002, 0.02})
    EXPECT_FALSE(names_drift(calibrate(drive(4, noise).a, drive(4, noise).b)));
  testing::Streams s = drive(5);
  const DualQuaternion knock =
      to_dual_quaternion(Pose{rotation_exp({0, 0.03, 0.06}), Eigen::Vector3d::Zero()});
  for (std::size_t i = s.b.size() / 2; i < s.b.size(); ++i) s.b[i].pose = s.b[i].pose * knock;
  EXPECT_FALSE(names_drift(calibrate(s.a, s.b)));
}

}  // namespace
}  // namespace egocal::test_turning_drift
