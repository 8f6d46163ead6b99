// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A stream that was made from the other one, in whole or in its rotations alone: its extrinsic is the answer,
// whatever it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_same_streams {
namespace {

using testing::drive;
using testing::find;

/// A stream that was made from the other one by an extrinsic has that as its answer, whatever it is.
TEST(SameStreams, AStreamThatWasMadeFromTheOtherIsNamed) {
  const testing::Streams right = drive(Terrain::rough);
  EXPECT_EQ(find(calibrate(right.a, right.b), "same_stream"), nullptr);
  Trajectory made = right.a;
  for (StampedPose& pose : made)
    pose.pose = canonical_sign(
        normalized(pose.pose * to_dual_quaternion(Pose{rotation_exp({0.4, -1.2, 0.3}), {0.3, 1.2, -0.6}})));
  const Calibration calibration = calibrate(right.a, made);
  const Finding* finding = find(calibration, "same_stream");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_FALSE(finding->certain);
  EXPECT_NE(finding->message.find("agree to rounding"), std::string::npos) << finding->message;
}

/// Two attitude sensors beside one GNSS receiver: the lever arm between them is none of the answer's.
TEST(SameStreams, PositionsOfOneSensorAreNamed) {
  const testing::Streams right = drive(Terrain::rough);
  ASSERT_EQ(right.a.size(), right.b.size());
  Trajectory made = right.b;
  const Pose other_world{rotation_exp({0.1, 0.2, -0.7}), {3, -2, 1}};
  for (const bool turned : {false, true}) {
    for (std::size_t i = 0; i < made.size(); ++i) {
      Pose pose = to_pose(right.b[i].pose);
      pose.translation = to_pose(right.a[i].pose).translation;
      made[i].pose = canonical_sign(to_dual_quaternion(turned ? other_world * pose : pose));
    }
    const Calibration calibration = calibrate(right.a, made);
    const Finding* const finding = find(calibration, "same_stream");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_NE(finding->message.find("travel the same distances to rounding"), std::string::npos)
        << finding->message;
  }
}

/// Two receivers on one vehicle travel the same distances on straight lines, to the digits of their files.
TEST(SameStreams, StraightLinesAreNoSignOfOneReceiver) {
  Trajectory a, b;
  const Pose mounting{Rotation(rotation_exp({0, 0, 0.2})), {0.9, 0.3, 0.1}};
  const auto in_centimetres = [](const Pose& pose) {
    return Pose{pose.rotation, (pose.translation * 100).array().round() / 100};
  };
  double x = 0, y = 0, heading = 0;
  for (int i = 0; i < 1200; ++i) {
    const bool turns = i % 120 >= 100;  // 10 s straight on, then a quarter turn
    heading += turns ? 0.0785 : 0;
    x += 0.1 * std::cos(heading);
    y += 0.1 * std::sin(heading);
    const Pose body{Rotation(rotation_exp({0.05 * std::sin(0.01 * i), 0.05 * std::sin(0.013 * i), heading})),
                    {x, y, 0}};
    a.push_back({100'000 * i, to_dual_quaternion(in_centimetres(body))});
    b.push_back({100'000 * i, to_dual_quaternion(in_centimetres(body * mounting))});
  }
  const Calibration calibration = calibrate(a, b);
  EXPECT_EQ(find(calibration, "same_stream"), nullptr) << calibration.reason;
}

/// Poses of which one half was never filled in, in both streams: the motions agree, and hold nothing of it.
TEST(SameStreams, AHalfThatIsMissingInBothIsNotKnown) {
  const testing::Streams right = drive(Terrain::rough);
  for (const Eigen::Vector3d& constant :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(452000.123, 5411000.456, 300)}) {
    Trajectory a = right.a, b = right.b;
    for (Trajectory* const stream : {&a, &b})
      for (StampedPose& pose : *stream)
        pose.pose = to_dual_quaternion(Pose{to_pose(pose.pose).rotation, constant});
    const Calibration calibration = calibrate(a, b);
    EXPECT_EQ(calibration.verdict, Verdict::incomplete) << calibration.reason;
    const Finding* const finding = find(calibration, "missing_both");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(calibration.observability.observable[i], i >= 3) << i;
  }
  Trajectory a = right.a, b = right.b;
  for (Trajectory* const stream : {&a, &b})
    for (StampedPose& pose : *stream)
      pose.pose = to_dual_quaternion(Pose{Rotation::Identity(), to_pose(pose.pose).translation});
  const Calibration calibration = calibrate(a, b);
  const Finding* const finding = find(calibration, "missing_both");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_FALSE(finding->certain) << "sensors on rails do not turn";
  EXPECT_NE(calibration.verdict, Verdict::good);
}

/// Rotations of one sensor in both streams, positions that are smoothed.
TEST(SameStreams, RotationsThatWereMadeFromTheOthersAreNamed) {
  const testing::Streams right = drive(Terrain::rough);
  Trajectory made = right.a;
  for (StampedPose& pose : made)
    pose.pose = canonical_sign(
        normalized(pose.pose * to_dual_quaternion(Pose{rotation_exp({0.4, -1.2, 0.3}), {0.3, 1.2, -0.6}})));
  Trajectory smoothed = made;
  for (std::size_t i = 1; i + 1 < made.size(); ++i) {
    Pose pose = to_pose(made[i].pose);
    pose.translation =
        (to_pose(made[i - 1].pose).translation + pose.translation + to_pose(made[i + 1].pose).translation) /
        3;
    smoothed[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  const Calibration calibration = calibrate(right.a, smoothed);
  const Finding* finding = find(calibration, "same_stream");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_FALSE(finding->certain);
  EXPECT_NE(finding->message.find("turn by the same angles to rounding"), std::string::npos)
      << finding->message;
}

/// By a wrong extrinsic, beside positions in a world of their own: axes explain that, and leave the rotation
/// that was put in.
TEST(SameStreams, RotationsThatWereMadeComeBeforeTheAxesThatTheyLookLike) {
  const testing::Streams right = drive(Terrain::rough);
  ASSERT_EQ(right.a.size(), right.b.size());
  const Rotation put_in = to_pose(right.T).rotation * rotation_exp({0.03, -0.04, 0.03});
  const Pose other_world{rotation_exp({0, 0, 2}), {3, -2, 1}};
  Trajectory made = right.b;
  for (std::size_t i = 0; i < made.size(); ++i) {
    const Pose position = other_world * to_pose(right.b[i].pose);
    made[i].pose = canonical_sign(
        to_dual_quaternion(Pose{Rotation(to_pose(right.a[i].pose).rotation * put_in), position.translation}));
  }
  const Calibration calibration = calibrate(right.a, made);
  ASSERT_FALSE(calibration.findings.empty());
  EXPECT_EQ(calibration.findings.front().code, "same_stream") << calibration.findings.front().message;
  EXPECT_EQ(calibration.verdict, Verdict::contradictory);
}

/// The odometry, and the pose in a map that corrects it each four seconds: where the odometry stands or goes
/// straight on the map does not, which is no gap that was filled in.
TEST(SameStreams, APoseInAMapAndTheOdometryThatItWasMadeFromAreNamed) {
  SimulationOptions options;
  options.poses = 2401;
  options.rate = 40;  // from row to row the vehicle hardly turns
  options.relative_noise = 0.01;
  const testing::Streams right = testing::simulated_drive(options);
  Trajectory in_map = right.a;
  DualQuaternion correction = to_dual_quaternion(Pose{});
  for (std::size_t i = 0; i < in_map.size(); ++i) {
    const double size = (i / 160) % 2 == 0 ? 0.01 : -0.02;
    if (i % 160 == 80)
      correction =
          to_dual_quaternion(Pose{rotation_exp({0, 0, size}), {3 * size, -2 * size, 0}}) * correction;
    in_map[i].pose = canonical_sign(normalized(correction * in_map[i].pose));
  }
  const Calibration calibration = calibrate(right.a, in_map);
  EXPECT_NE(find(calibration, "same_stream"), nullptr) << calibration.reason;
  EXPECT_EQ(find(calibration, "filled_a"), nullptr) << calibration.reason;
  EXPECT_EQ(find(calibration, "filled_b"), nullptr) << calibration.reason;
}

/// Made from a by any extrinsic, at stamps of its own between two poses of a.
TEST(SameStreams, AStreamThatWasInterpolatedFromTheOtherIsNamed) {
  const testing::Streams right = drive(Terrain::rough);
  const DualQuaternion wrong = to_dual_quaternion(Pose{rotation_exp({0.4, -1.2, 0.3}), {0.3, 1.2, -0.6}});
  Trajectory made;
  for (std::size_t i = 1; i < right.a.size(); i += 2) {
    const StampedPose &from = right.a[i - 1], &to = right.a[i];
    const Pose before = to_pose(from.pose), after = to_pose(to.pose);
    const Pose between{before.rotation.slerp(0.3, after.rotation),
                       before.translation + 0.3 * (after.translation - before.translation)};
    made.push_back({from.time_us + std::llround(0.3 * static_cast<double>(to.time_us - from.time_us)),
                    canonical_sign(normalized(to_dual_quaternion(between) * wrong))});
  }
  for (const bool exchanged : {false, true}) {
    const Calibration calibration = exchanged ? calibrate(made, right.a) : calibrate(right.a, made);
    const Finding* finding = find(calibration, "same_stream");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_TRUE(finding->certain);
    EXPECT_EQ(calibration.verdict, Verdict::doubtful) << calibration.reason;
    EXPECT_EQ(finding->message.find(exchanged ? "The poses of a lie" : "The poses of b lie"), 0u)
        << finding->message;
  }
}

/// Without noise the poses of two sensors are near the lines between each other, but not on them.
TEST(SameStreams, SensorsWithoutNoiseAtOtherStampsAreNoCopies) {
  SimulationOptions simulation;
  simulation.terrain = Terrain::rough;
  simulation.poses = 601;
  const testing::Streams exact = testing::simulated_drive(simulation);
  Trajectory a, b;
  for (std::size_t i = 0; i + 1 < exact.a.size(); i += 2) {
    a.push_back(exact.a[i]);
    b.push_back(exact.b[i + 1]);
  }
  const Finding* finding = find(calibrate(a, b), "same_stream");
  EXPECT_TRUE(finding == nullptr || !finding->certain) << finding->message;
}

/// On a straight road neither sensor turns, which is no sign of a copy.
TEST(SameStreams, RotationsThatNeverChangeAreNoCopies) {
  Trajectory a, b;
  for (int i = 0; i < 200; ++i) {
    const double x = 0.5 * i, wobble = 0.01 * std::sin(7.0 * i);
    a.push_back({i * 100'000, to_dual_quaternion(Pose{{1, 0, 0, 0}, {x, 0, 0}})});
    b.push_back({i * 100'000, to_dual_quaternion(Pose{{1, 0, 0, 0}, {x + wobble, wobble, 0}})});
  }
  EXPECT_EQ(find(calibrate(a, b), "same_stream"), nullptr);
}

/// The same, written with few digits: rounding hides that the motions agree as those of no two sensors do.
TEST(SameStreams, AStreamThatWasMadeFromTheOtherAndRoundedIsNamed) {
  const testing::Streams right = drive(Terrain::rough);
  const Pose wrong{rotation_exp({0.4, -1.2, 0.3}), {0.3, 1.2, -0.6}};
  const auto decimals = [](int count) {
    return [unit = std::pow(10, -count)](double x) { return unit * std::round(x / unit); };
  };
  const auto six_digits = [](double x) {
    const double unit = x == 0 ? 1 : std::pow(10, std::floor(std::log10(std::abs(x))) - 5);
    return unit * std::round(x / unit);
  };
  using Write = std::function<double(double)>;
  const auto written = [](Trajectory poses, const Write& position, const Write& rotation) {
    for (StampedPose& stamped : poses) {
      const Pose pose = to_pose(stamped.pose);
      const Eigen::Vector4d q = pose.rotation.coeffs().unaryExpr(rotation);
      stamped.pose = canonical_sign(to_dual_quaternion(
          Pose{Rotation(Eigen::Vector4d(q.normalized())), pose.translation.unaryExpr(position)}));
    }
    return poses;
  };
  Trajectory made = right.a;
  for (StampedPose& pose : made)
    pose.pose = canonical_sign(normalized(pose.pose * to_dual_quaternion(wrong)));
  for (const auto& [position, rotation] : {std::pair<Write, Write>{decimals(3), decimals(4)},
                                           {decimals(4), decimals(5)},
                                           {six_digits, six_digits}}) {
    const Calibration calibration = calibrate(right.a, written(made, position, rotation));
    const Finding* finding = find(calibration, "same_stream");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_FALSE(finding->certain);
    EXPECT_NE(finding->message.find("agree to the rounding"), std::string::npos) << finding->message;
    EXPECT_EQ(find(calibrate(right.a, written(right.b, position, rotation)), "same_stream"), nullptr);
    // its answer is the identity, which is a reason of its own
    const Calibration copied = calibrate(right.a, written(right.a, position, rotation));
    EXPECT_EQ(std::count_if(copied.findings.begin(), copied.findings.end(),
                            [](const Finding& one) { return one.code == "same_stream"; }),
              1);
  }
}

}  // namespace
}  // namespace egocal::test_same_streams
