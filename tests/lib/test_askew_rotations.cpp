// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Gyroscopes whose axes are askew: every part of the drive has the same wrong answer.
#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>

#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "diagnosis/explanations/turning/askew_rotations.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_askew_rotations {
namespace {

using testing::find;

constexpr double degree = std::numbers::pi / 180;

testing::Streams noisy(Terrain terrain, std::uint64_t seed) {
  SimulationOptions options;
  options.terrain = terrain;
  options.poses = 901;
  options.relative_noise = 0.04;
  options.seed = seed;
  return testing::simulated_drive(options);
}

/// The rotations are those of a gyroscope that is turned against what measures the way that is travelled; the
/// positions are made from both.
Trajectory with_askew_gyroscope(const Trajectory& poses, const Eigen::Vector3d& turn) {
  const Rotation askew = rotation_exp(turn);
  Trajectory result = poses;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    Pose motion = to_pose(conjugate(poses[i - 1].pose) * poses[i].pose);
    motion.rotation = askew * motion.rotation * askew.conjugate();
    result[i].pose = normalized(result[i - 1].pose * to_dual_quaternion(motion));
  }
  return result;
}

TEST(AskewRotations, AreNamed) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    testing::Streams streams = noisy(Terrain::free, seed);
    streams.b = with_askew_gyroscope(streams.b, {3 * degree, 0, -2 * degree});
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Finding* finding = find(calibration, "odometry");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_FALSE(finding->certain) << finding->message;
    EXPECT_FALSE(finding->remedy.empty());
  }
}

/// An odometry that drifts in one direction may have the same turns beside a right answer.
TEST(AskewRotations, LeaveTheVerdict) {
  testing::Streams streams = noisy(Terrain::free, 3);
  streams.b = with_askew_gyroscope(streams.b, {3 * degree, 0, 0});
  const Calibration calibration = calibrate(streams.a, streams.b);
  ASSERT_NE(find(calibration, "odometry"), nullptr) << calibration.reason;
  EXPECT_EQ(calibration.verdict, Verdict::good) << calibration.reason;
}

TEST(AskewRotations, AreNotFoundInRightStreams) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free})
    for (std::uint64_t seed = 11; seed <= 13; ++seed) {
      const testing::Streams streams = noisy(terrain, seed);
      const detail::Instants instants = detail::synchronised(streams.a, streams.b, {}, 0.5);
      EXPECT_FALSE(detail::askew(instants, 28, streams.T, {})) << seed;
    }
}

}  // namespace
}  // namespace egocal::test_askew_rotations
