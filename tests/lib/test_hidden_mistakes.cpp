// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Mistakes that leave motions which nearly agree, and an answer that is wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

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

/// A stream that was made from the other one by an extrinsic has that as its answer, whatever it is.
TEST(HiddenMistakes, AStreamThatWasMadeFromTheOtherIsNamed) {
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

/// Rotations of one sensor in both streams, positions that are smoothed.
TEST(HiddenMistakes, RotationsThatWereMadeFromTheOthersAreNamed) {
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

/// Made from a by any extrinsic, at stamps of its own between two poses of a.
TEST(HiddenMistakes, AStreamThatWasInterpolatedFromTheOtherIsNamed) {
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
    EXPECT_FALSE(finding->certain);
  }
}

/// On a straight road neither sensor turns, which is no sign of a copy.
TEST(HiddenMistakes, RotationsThatNeverChangeAreNoCopies) {
  Trajectory a, b;
  for (int i = 0; i < 200; ++i) {
    const double x = 0.5 * i, wobble = 0.01 * std::sin(7.0 * i);
    a.push_back({i * 100'000, to_dual_quaternion(Pose{{1, 0, 0, 0}, {x, 0, 0}})});
    b.push_back({i * 100'000, to_dual_quaternion(Pose{{1, 0, 0, 0}, {x + wobble, wobble, 0}})});
  }
  EXPECT_EQ(find(calibrate(a, b), "same_stream"), nullptr);
}

/// The same, written with few digits: rounding hides that the motions agree as those of no two sensors do.
TEST(HiddenMistakes, AStreamThatWasMadeFromTheOtherAndRoundedIsNamed) {
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

/// Late positions of one stream are early ones of the other. Rows that are off by one show which it is where
/// noise is small; else both are named, the late one first, and that one of them is wrong is certain.
void expect_late(const Calibration& calibration, const std::string& late, const std::string& early,
                 double delay) {
  std::vector<std::string> codes;
  bool certain = false;
  for (const Finding& finding : calibration.findings) {
    if (!finding.code.starts_with("late_positions_")) continue;
    codes.push_back(finding.code);
    certain = certain || finding.certain;
    EXPECT_EQ(finding.message.find(", or those of ") == std::string::npos, finding.certain)
        << finding.message;
    ASSERT_TRUE(finding.value && finding.T_a_b);
    EXPECT_NEAR(*finding.value, finding.code == late ? delay : -delay, 0.05);
  }
  const std::vector<std::string> both{late, early};
  EXPECT_EQ(codes, certain ? std::vector<std::string>{late} : both) << calibration.reason;
}

/// A filter that is late by 0.3 s, of the positions alone. Turns that are quick and a long lever arm show in
/// which stream.
TEST(HiddenMistakes, PositionsThatAreLaterThanTheRotationsAreNamed) {
  for (const Side side : {Side::a, Side::b}) {
    testing::Streams streams = bounded_drive();
    EXPECT_EQ(find(calibrate(streams.a, streams.b), "late_positions_b"), nullptr);
    Trajectory& wrong = side == Side::a ? streams.a : streams.b;
    wrong = testing::with_late_positions(wrong, 3);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_GE(calibration.verdict, Verdict::doubtful) << calibration.reason;
    const bool of_a = side == Side::a;
    const Finding* finding = find(calibration, of_a ? "late_positions_a" : "late_positions_b");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_TRUE(finding->certain);
    EXPECT_EQ(find(calibration, of_a ? "late_positions_b" : "late_positions_a"), nullptr);
    ASSERT_TRUE(finding->value && finding->T_a_b);
    EXPECT_NEAR(*finding->value, 0.3, 0.05);
    const auto off_by = [&](const Pose& T) {
      return extrinsic_error(streams.T, to_dual_quaternion(T)).translation;
    };
    EXPECT_LT(off_by(finding->T_a_b.value()), 0.5 * off_by(calibration.T_a_b));
  }
}

/// Rows off by one on a road: the verdict is as if one stream were named.
TEST(HiddenMistakes, OnARoadEitherStreamMayHaveTheLatePositions) {
  for (const double noise : {0.001, 0.01})
    for (const Side side : {Side::a, Side::b}) {
      SimulationOptions simulation;
      simulation.terrain = Terrain::rough;
      simulation.poses = 601;
      simulation.relative_noise = noise;
      simulation.speed_variation = 0.3;
      simulation.seed = 7;
      testing::Streams streams = testing::simulated_drive(simulation);
      Trajectory& wrong = side == Side::a ? streams.a : streams.b;
      wrong = testing::with_late_positions(wrong, 1);
      const Calibration calibration = calibrate(streams.a, streams.b);
      EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
      if (side == Side::a)
        expect_late(calibration, "late_positions_a", "late_positions_b", 0.1);
      else
        expect_late(calibration, "late_positions_b", "late_positions_a", 0.1);
    }
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

/// A filter that delays the rotations alone looks like a clock that is off, and at that clock the positions
/// are early.
TEST(HiddenMistakes, RotationsThatAreLaterThanThePositionsAreNamed) {
  testing::Streams streams = bounded_drive();
  constexpr std::size_t late = 3;  // poses, of 10 a second
  for (std::size_t i = streams.b.size() - 1; i >= late; --i) {
    Pose pose = to_pose(streams.b[i].pose);
    pose.rotation = to_pose(streams.b[i - late].pose).rotation;
    streams.b[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_NE(calibration.verdict, Verdict::good) << calibration.reason;
  const Finding *clock = find(calibration, "clock_offset"),
                *positions = find(calibration, "late_positions_b");
  ASSERT_NE(clock, nullptr) << calibration.reason;
  ASSERT_NE(positions, nullptr) << calibration.reason;
  EXPECT_NEAR(*clock->value, -0.3, 0.1);
  EXPECT_NEAR(*positions->value, -0.3, 0.1);
  ASSERT_TRUE(positions->T_a_b);
  EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*positions->T_a_b)).rotation, 0.01);
}

/// Whatever moved the sensor between the poses that were measured is lost.
TEST(HiddenMistakes, AStreamThatWasInterpolatedIsNamed) {
  testing::Streams streams = bounded_drive();
  streams.b = testing::interpolated(streams.b, 10);
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* finding = find(calibration, "undersampled_b");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_NE(finding->message.find("between about 1.0 poses a second"), std::string::npos) << finding->message;
  EXPECT_EQ(find(calibration, "undersampled_a"), nullptr);
}

TEST(HiddenMistakes, PositionsAloneThatWereInterpolatedAreNamed) {
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
TEST(HiddenMistakes, ASmoothStreamBesideANoisyOneIsNoInterpolation) {
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

/// An offset that is estimated from rotations and positions of different times lies between both: such
/// answers were good and 60 cm off, with the cure that was printed without it.
TEST(HiddenMistakes, RotationsThatAreLaterThanThePositionsAreNamedBesideAnEstimatedOffset) {
  testing::Streams streams = bounded_drive();
  for (std::size_t i = streams.b.size() - 1; i >= 1; --i) {
    Pose pose = to_pose(streams.b[i].pose);
    pose.rotation = to_pose(streams.b[i - 1].pose).rotation;
    streams.b[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  CalibrationOptions options;
  options.estimate_time_offset = true;
  const Calibration calibration = calibrate(streams.a, streams.b, options);
  EXPECT_NE(calibration.verdict, Verdict::good) << calibration.reason;
  const Finding* finding = find(calibration, "late_positions_b");
  if (!finding) finding = find(calibration, "late_positions_a");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_NEAR(std::abs(*finding->value), 0.1, 0.03);
  ASSERT_TRUE(finding->T_a_b);
  EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*finding->T_a_b)).rotation, 0.01);
}

/// Straight lines that both sensors drive are no interpolation.
TEST(HiddenMistakes, SteadyMotionIsNoInterpolation) {
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
}  // namespace egocal::test_hidden_mistakes
