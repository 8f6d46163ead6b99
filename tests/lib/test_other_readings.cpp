// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses that are inverted or in other axes are named, with the option that cures it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "../support/bounded_drive.hpp"
#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_other_readings {
namespace {

using testing::drive;
using testing::find;

TEST(OtherReadings, TheRemedyOfAReadingCures) {
  testing::Streams streams = drive(Terrain::free);
  const Pose right = calibrate(streams.a, streams.b).T_a_b;
  streams.a = testing::scalar_first(streams.a);
  streams.b = testing::inverted(streams.b);
  CalibrationOptions options;
  options.read_a.quaternion_order = QuaternionOrder::wxyz;
  options.read_b.invert = true;
  const Calibration cured = calibrate(streams.a, streams.b, options);
  EXPECT_EQ(cured.verdict, Verdict::good) << cured.reason;
  EXPECT_LT((cured.T_a_b.translation - right.translation).norm(), 1e-6);
}

// Rows of COLMAP in a file of x y z w: a mount that moved was named, or nothing.
TEST(OtherReadings, ScalarFirstAndInvertedIsNamedWithBothOptions) {
  for (const bool in_a : {true, false}) {
    testing::Streams streams = drive(Terrain::rough);
    Trajectory& wrong = in_a ? streams.a : streams.b;
    wrong = testing::scalar_first(testing::inverted(wrong));
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
    const Finding* finding = find(calibration, in_a ? "quaternion_order_a" : "quaternion_order_b");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_NE(finding->message.find("and its poses are world-to-sensor"), std::string::npos)
        << finding->message;
    EXPECT_EQ(finding->remedy,
              in_a ? "--quaternion-order-a wxyz --invert-a" : "--quaternion-order-b wxyz --invert-b");
  }
}

// A map that is bent by a correction spread over the drive, a kilometre from its origin: under inverse poses
// the motions are long, and a scale of 0.02 hid that they fit no better in metres.
TEST(OtherReadings, AMapThatIsBentIsNotScalarFirstAndInverted) {
  testing::Random random(5);
  const Pose mount_a{rotation_exp({0.1, -0.2, 0.4}), {0.1, 0.2, 0.3}},
      mount_b{rotation_exp({1, -0.9, 0.4}), {0.14, 0.2, 0.33}};
  testing::Streams streams;
  constexpr int poses = 901;
  for (int i = 0; i < poses; ++i) {
    const double t = 0.1 * i;
    const Eigen::Vector3d turn(0.35 * std::sin(0.7 * t) + 0.2 * std::sin(1.9 * t + 1),
                               0.35 * std::sin(0.9 * t + 2), 0.8 * std::sin(0.31 * t));
    const Pose rig{rotation_exp(turn),
                   {0.5 * std::sin(0.4 * t), 0.4 * std::sin(0.53 * t + 1), 0.3 * std::sin(0.67 * t + 2)}};
    const double bent = 3 * std::numbers::pi / 180 * i / poses;
    const Pose world =
        Pose{rotation_exp({0, 0, bent}), {0, 0, 0}} * Pose{Rotation::Identity(), {-1000, 70, 0}};
    const auto noise = [&] { return Pose{rotation_exp(random.normal3(0.001)), random.normal3(0.002)}; };
    const auto time_us = std::int64_t{100'000} * i;
    streams.a.push_back({time_us, canonical_sign(to_dual_quaternion(rig * mount_a * noise()))});
    streams.b.push_back({time_us, canonical_sign(to_dual_quaternion(world * rig * mount_b * noise()))});
  }
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(find(calibration, "quaternion_order_b"), nullptr) << calibration.reason;
  EXPECT_EQ(find(calibration, "quaternion_order_a"), nullptr) << calibration.reason;
  EXPECT_GE(calibration.verdict, Verdict::doubtful) << calibration.reason;
}

// Of a camera without scale as well.
TEST(OtherReadings, ScalarFirstAndInvertedIsNamedAtAnotherScale) {
  for (const double scale : {0.1, 20.0}) {
    testing::Streams streams = drive(Terrain::free);
    streams.b = testing::scalar_first(testing::inverted(testing::lengthened(streams.b, scale)));
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_NE(find(calibration, "quaternion_order_b"), nullptr) << scale << ": " << calibration.reason;
  }
}

/// Turned axes of one stream are those of the other one up to the lever arm: one of them is named.
TEST(OtherReadings, PositionsInAnotherWorldFrameAreNamed) {
  testing::Streams streams = drive(Terrain::free);
  const Eigen::Matrix3d turn = rotation_exp({0.2, -0.1, 0.6}).toRotationMatrix();
  streams.b = testing::with_position_columns(streams.b, turn);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
  EXPECT_TRUE(find(calibration, "axes_a") || find(calibration, "axes_b")) << calibration.reason;
}

TEST(OtherReadings, AnInvertedStreamContradictsWhicheverOfTheTwoItIs) {
  testing::Streams streams = testing::bounded_drive();
  EXPECT_EQ(calibrate(streams.a, streams.b).verdict, Verdict::good);
  streams.a = testing::inverted(streams.a);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_NE(find(calibration, "inverted_a"), nullptr) << calibration.reason;
  EXPECT_EQ(calibration.verdict, Verdict::contradictory);
}

TEST(OtherReadings, PositionsMirroredAtTheOriginMayBeThoseOfEitherStream) {
  testing::Streams streams = drive(Terrain::free);
  streams.b = testing::lengthened(streams.b, -1);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::contradictory);
  for (const char* code : {"axes_a", "axes_b"}) {
    const Finding* finding = find(calibration, code);
    ASSERT_NE(finding, nullptr) << code;
    EXPECT_NE(finding->message.find("x from -x, y from -y, z from -z"), std::string::npos);
  }
}

TEST(OtherReadings, ALeftHandedStreamIsNotGood) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free}) {
    testing::Streams streams = drive(terrain);
    streams.b = testing::mirrored(streams.b);
    EXPECT_NE(calibrate(streams.a, streams.b).verdict, Verdict::good);
  }
}

/// With the coordinates of a map: a thousand kilometres from the origin.
Trajectory on_a_map(Trajectory trajectory) {
  const DualQuaternion shift = to_dual_quaternion(Pose{Eigen::Quaterniond::Identity(), {5e5, 5.4e6, 300}});
  for (StampedPose& pose : trajectory) pose.pose = canonical_sign(shift * pose.pose);
  return trajectory;
}

TEST(OtherReadings, CoordinatesOfAMapAreNeitherFrozenNorMissing) {
  testing::Streams streams = drive(Terrain::free);
  streams.a = on_a_map(streams.a);
  streams.b = testing::inverted(on_a_map(streams.b));
  const Calibration calibration = calibrate(streams.a, streams.b);
  for (const char* code : {"frozen_a", "frozen_b", "missing_a", "missing_b"})
    EXPECT_EQ(find(calibration, code), nullptr) << code;
  EXPECT_NE(find(calibration, "inverted_b"), nullptr) << calibration.reason;
}

TEST(OtherReadings, BothInvertedOnAMapIsNotCalledAWrongUnitOfTime) {
  testing::Streams streams = drive(Terrain::free);
  streams.a = testing::inverted(on_a_map(streams.a));
  streams.b = testing::inverted(on_a_map(streams.b));
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(find(calibration, "time_unit"), nullptr);
  const Finding* finding = find(calibration, "inverted_both");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_TRUE(finding->certain);
}

TEST(OtherReadings, BothInvertedIsNotMentionedWhereMetresSayOtherwise) {
  testing::Streams streams = drive(Terrain::free);
  streams.a = on_a_map(streams.a);
  streams.b = on_a_map(streams.b);
  EXPECT_EQ(find(calibrate(streams.a, streams.b), "inverted_both"), nullptr);
}

/// An odometry that jumps has one mounting under the right reading only, whichever way the body goes. In a
/// long drive as well, of which not every motion is looked at.
class OdometryThatJumps : public ::testing::TestWithParam<int> {};

TEST_P(OdometryThatJumps, IsCertainlyInvertedIfBothAre) {
  testing::Streams streams = testing::noisy_drive(Terrain::free, 0, GetParam());
  for (const double part : {0.2, 0.4, 0.5, 0.7, 0.9}) {
    const auto from = static_cast<std::size_t>(part * static_cast<double>(streams.b.size()));
    const DualQuaternion jump =
        to_dual_quaternion({rotation_exp({0.2, -0.1 - part, 0.3}), {3, -1, 2 * part}});
    for (std::size_t i = from; i < streams.b.size(); ++i) streams.b[i].pose = jump * streams.b[i].pose;
  }
  const Calibration right = calibrate(streams.a, streams.b);
  const Finding* finding = find(right, "inverted_both");
  EXPECT_TRUE(finding == nullptr || !finding->certain);
  const Calibration wrong = calibrate(testing::inverted(streams.a), testing::inverted(streams.b));
  finding = find(wrong, "inverted_both");
  ASSERT_NE(finding, nullptr) << wrong.reason;
  EXPECT_TRUE(finding->certain);
  EXPECT_EQ(wrong.verdict, Verdict::contradictory);
}

INSTANTIATE_TEST_SUITE_P(Poses, OdometryThatJumps, ::testing::Values(601, 6001));

}  // namespace
}  // namespace egocal::test_other_readings
