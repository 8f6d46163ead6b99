// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Mistakes that leave motions which nearly agree, and an answer that is wrong.
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "../support/bounded_drive.hpp"
#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_hidden_mistakes {
namespace {

using testing::bounded_drive;
using testing::drive;
using testing::find;

/// One program wrote both files. Where both sensors look the same way at the begin the motions agree nearly,
/// and the answer is wrong.
TEST(HiddenMistakes, TheSameWrongAxesInBothStreamsAreNamed) {
  Eigen::Matrix3d cycle;
  cycle << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const auto columns = [&](const Trajectory& poses) { return testing::with_position_columns(poses, cycle); };
  const testing::Streams right = bounded_drive();
  EXPECT_EQ(find(calibrate(right.a, right.b), "axes_both"), nullptr);
  for (const auto& [name, wrong] : {std::pair<const char*, std::function<Trajectory(const Trajectory&)>>{
                                        "rotation taken as its inverse", testing::with_inverse_rotations},
                                    {"position columns read as x from z, y from x, z from y", columns}}) {
    const Calibration calibration = calibrate(wrong(right.a), wrong(right.b));
    EXPECT_EQ(calibration.verdict, Verdict::contradictory) << name << ": " << calibration.reason;
    const Finding* finding = find(calibration, "axes_both");
    ASSERT_NE(finding, nullptr) << name << ": " << calibration.reason;
    EXPECT_TRUE(finding->certain);
    EXPECT_NE(finding->message.find(name), std::string::npos) << finding->message;
    ASSERT_TRUE(finding->T_a_b);
    EXPECT_LT(extrinsic_error(right.T, to_dual_quaternion(*finding->T_a_b)).rotation, 0.01) << name;
  }
}

/// With noise of 1 % half a minute on rough ground shows inverse rotations of both files, but does not prove
/// them.
TEST(HiddenMistakes, InverseRotationsOfBothFilesThatAreOnlyProbableMakeTheAnswerDoubtful) {
  testing::Streams right = drive(Terrain::rough);
  right.a.resize(right.a.size() / 2);
  right.b.resize(right.b.size() / 2);
  EXPECT_EQ(find(calibrate(right.a, right.b), "axes_both"), nullptr);
  const Calibration calibration =
      calibrate(testing::with_inverse_rotations(right.a), testing::with_inverse_rotations(right.b));
  EXPECT_EQ(calibration.verdict, Verdict::doubtful) << calibration.reason;
  const Finding* finding = find(calibration, "axes_both");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_FALSE(finding->certain);
  ASSERT_TRUE(finding->T_a_b);
  EXPECT_LT(extrinsic_error(right.T, to_dual_quaternion(*finding->T_a_b)).rotation, 0.02);
}

/// Rotations of a gyroscope that sits askew beside positions that something else measures.
Trajectory with_tilted_rotations(const Trajectory& trajectory, double degrees) {
  const Rotation tilt = rotation_exp(degrees * std::numbers::pi / 180 * Eigen::Vector3d(0.6, -0.8, 0));
  const Rotation first = to_pose(trajectory.front().pose).rotation;
  return testing::changed(trajectory, [&](const Pose& pose) {
    return Pose{first * tilt * first.conjugate() * pose.rotation * tilt.conjugate(), pose.translation};
  });
}

/// A gyroscope that sits askew turns in other axes than its positions, which an odometry beside it measures.
/// Where the sensors turn, lengths of both streams are unlike, and no scale of b.
TEST(HiddenMistakes, RotationsInAxesThatAreTiltedAgainstThePositionsAreNamed) {
  for (const double degrees : {1.5, 3.0}) {
    testing::Streams streams = testing::noisy_drive(Terrain::free, 1e-3);
    const DualQuaternion far_off = to_dual_quaternion(Pose{Rotation::Identity(), {3, -4, 2}});
    for (StampedPose& pose : streams.b) pose.pose = canonical_sign(normalized(pose.pose * far_off));
    streams.T = streams.T * far_off;
    EXPECT_EQ(find(calibrate(streams.a, streams.b), "axes_b"), nullptr);
    streams.b = with_tilted_rotations(streams.b, degrees);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(calibration.verdict, Verdict::contradictory) << degrees << ": " << calibration.reason;
    const Finding* finding = find(calibration, "axes_b");
    ASSERT_NE(finding, nullptr) << degrees << ": " << calibration.reason;
    EXPECT_TRUE(finding->certain);
    EXPECT_GT(finding->improvement, 50);
    EXPECT_EQ(find(calibration, "axes_a"), nullptr);
  }
}

/// Drifting odometries turn positions against rotations as well, but explain less by it.
TEST(HiddenMistakes, RotationsThatAreTiltedBesideMoreNoiseArePossible) {
  const testing::Streams streams = testing::noisy_drive(Terrain::free, 0.02);
  EXPECT_EQ(find(calibrate(streams.a, streams.b), "axes_b"), nullptr);
  const Calibration calibration = calibrate(streams.a, with_tilted_rotations(streams.b, 3));
  const Finding* finding = find(calibration, "axes_b");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_FALSE(finding->certain);
}

/// Positions in another world frame: twelve linear unknowns and what noise makes of them are only the start.
TEST(HiddenMistakes, PositionsThatAreTurnedByAnyAngleHaveAnAnswerOfTheirOwn) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.3, -0.2, 0.9).normalized()).toRotationMatrix();
  for (const Terrain terrain : {Terrain::free, Terrain::rough}) {
    testing::Streams streams = drive(terrain);
    const ExtrinsicError without =
        extrinsic_error(streams.T, to_dual_quaternion(calibrate(streams.a, streams.b).T_a_b));
    streams.b = testing::with_position_columns(streams.b, turn);
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Finding* finding = find(calibration, "axes_b");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    ASSERT_TRUE(finding->T_a_b);
    const ExtrinsicError with = extrinsic_error(streams.T, to_dual_quaternion(*finding->T_a_b));
    EXPECT_LT(with.rotation, without.rotation + 0.01);
    const std::string words = "positions turned by ";
    const std::size_t at = finding->message.find(words);
    ASSERT_NE(at, std::string::npos) << finding->message;
    const double degrees = std::stod(finding->message.substr(at + words.size()));
    EXPECT_NEAR(degrees, 40.1, 1) << finding->message;
  }
}

/// A file whose convention changes on its way: the option alone cures nothing.
TEST(HiddenMistakes, AStreamThatIsInvertedFromSomeTimeOnSaysSo) {
  testing::Streams streams = drive(Terrain::free);
  const Trajectory inverted = testing::inverted(streams.b);
  std::copy(inverted.begin() + static_cast<std::ptrdiff_t>(inverted.size()) * 3 / 10, inverted.end(),
            streams.b.begin() + static_cast<std::ptrdiff_t>(inverted.size()) * 3 / 10);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
  const Finding* finding = find(calibration, "inverted_b");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_NE(finding->message.find("explains the drive without the part from 0 to "), std::string::npos)
      << finding->message;
  EXPECT_TRUE(finding->remedy.starts_with("Calibrate the drive from 0 to ")) << finding->remedy;
}

/// Moved to another point of the body by p + R'l. The motions nearly agree, with an answer about a metre off.
TEST(HiddenMistakes, ALeverArmThatWasTurnedByTheInverseRotationIsNamed) {
  const Eigen::Vector3d arm(0.3, 1.5, 0.5);
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const Side side : {Side::a, Side::b}) {
      testing::Streams s = drive(terrain);
      Trajectory& wrong = side == Side::a ? s.a : s.b;
      wrong = testing::with_turned_lever_arm(wrong, arm);
      const Calibration calibration = calibrate(s.a, s.b);
      EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
      const Finding* finding = find(calibration, side == Side::a ? "axes_a" : "axes_b");
      ASSERT_NE(finding, nullptr) << calibration.reason;
      EXPECT_TRUE(finding->certain);
      EXPECT_NE(finding->message.find("lever arm"), std::string::npos) << finding->message;
      ASSERT_TRUE(finding->T_a_b);
      EXPECT_LT(extrinsic_error(s.T, to_dual_quaternion(*finding->T_a_b)).translation, 0.3);
    }
}

/// A compass or a gyroscope that is not calibrated. On hills the answer was off by tens of degrees.
TEST(HiddenMistakes, HeadingsThatTurnTooFarAreNamed) {
  for (const Side side : {Side::a, Side::b})
    for (const double factor : {1.05, 0.97}) {
      testing::Streams s = drive(Terrain::rough, 2);
      Trajectory& wrong = side == Side::a ? s.a : s.b;
      wrong = testing::with_turning_scale(wrong, factor);
      const Calibration calibration = calibrate(s.a, s.b);
      const Finding* finding = find(calibration, side == Side::a ? "turning_scale_a" : "turning_scale_b");
      ASSERT_NE(finding, nullptr) << factor << ": " << calibration.reason;
      EXPECT_TRUE(finding->certain);
      EXPECT_NEAR(finding->value.value_or(0), factor, 0.003);
      EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
      ASSERT_TRUE(finding->T_a_b);
      EXPECT_LT(extrinsic_error(s.T, to_dual_quaternion(*finding->T_a_b)).rotation, 0.02);
    }
}

/// Quaternions of rotation vectors without the half of the angle, or with degrees for radians: all of the
/// motions contradict.
TEST(HiddenMistakes, RotationVectorsOfAnotherLengthAreNamed) {
  for (const Side side : {Side::a, Side::b})
    for (const double factor : {2.0, 0.5, std::numbers::pi / 180}) {
      testing::Streams s = drive(Terrain::rough, 2);
      Trajectory& wrong = side == Side::a ? s.a : s.b;
      wrong = testing::changed(wrong, [&](const Pose& pose) {
        return Pose{rotation_exp(factor * rotation_log(pose.rotation)), pose.translation};
      });
      const Calibration calibration = calibrate(s.a, s.b);
      const Finding* finding = find(calibration, side == Side::a ? "turning_scale_a" : "turning_scale_b");
      ASSERT_NE(finding, nullptr) << factor << ": " << calibration.reason;
      EXPECT_TRUE(finding->certain);
      EXPECT_NEAR(finding->value.value_or(0), factor, 1e-9);
      EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
      ASSERT_TRUE(finding->T_a_b);
      EXPECT_LT(extrinsic_error(s.T, to_dual_quaternion(*finding->T_a_b)).rotation, 0.02);
    }
}

}  // namespace
}  // namespace egocal::test_hidden_mistakes
