// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Every mistake of the catalogue is named on drives of several kinds, with the answer it should have been.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "../support/bounded_drive.hpp"
#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "../support/turning_machine.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_explanations {
namespace {

using testing::drive;
using testing::find;

class NamedMistake : public ::testing::TestWithParam<std::string> {
 protected:
  static testing::Mistake mistake() {
    for (testing::Mistake& one : testing::mistakes())
      if (one.name == GetParam()) return one;
    throw Error("no such mistake: " + GetParam());
  }
};

TEST_P(NamedMistake, OnAFreeDriveWithTheRightAnswer) {
  testing::Streams streams = drive(Terrain::free);
  mistake().make(streams);
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* finding = find(calibration, mistake().code);
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_TRUE(finding->certain);
  EXPECT_FALSE(finding->remedy.empty());
  ASSERT_TRUE(finding->T_a_b);
  if (mistake().code == "mount_moved") return;
  const ExtrinsicError error = extrinsic_error(streams.T, to_dual_quaternion(*finding->T_a_b));
  EXPECT_LT(error.rotation, 0.01);
  EXPECT_LT(error.translation, 0.1);
}

TEST_P(NamedMistake, OnARoad) {
  testing::Streams streams = drive(Terrain::rough, 2);
  mistake().make(streams);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_NE(find(calibration, mistake().code), nullptr) << calibration.reason;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, NamedMistake,
                         ::testing::Values("a inverted", "b inverted", "order of a", "order of b",
                                           "order of both", "scale 0.37", "scale 1.05",
                                           "scale of b 1.15 from the middle on", "b in millimetres",
                                           "a in millimetres", "clock 0.5 s off", "x and y of b exchanged",
                                           "x and y of a exchanged", "rotations of b inverse",
                                           "b knocked in the middle", "b turned round in the middle",
                                           "b turned aside early", "b turned aside late"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

TEST(Explanations, StreamsWithoutPositionsOrRotationsAreRefused) {
  int named = 0;
  for (const testing::Mistake& mistake : testing::mistakes()) {
    if (mistake.code != "missing_b") continue;
    for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
      testing::Streams streams = drive(terrain);
      mistake.make(streams);
      Calibration calibration;
      try {
        calibration = calibrate(streams.a, streams.b);
      } catch (const Error&) {
        continue;  // no motion of both sensors agrees: refused with one line
      }
      const Finding* finding = find(calibration, mistake.code);
      ASSERT_NE(finding, nullptr) << mistake.name << ": " << calibration.reason;
      EXPECT_EQ(calibration.verdict, Verdict::contradictory) << mistake.name;
      ++named;
    }
  }
  EXPECT_GT(named, 0);
}

TEST(Explanations, CleanDrivesHaveNoCertainFinding) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free}) {
    const testing::Streams streams = drive(terrain, 3);
    for (const Finding& finding : calibrate(streams.a, streams.b).findings)
      EXPECT_FALSE(finding.certain) << finding.code << ": " << finding.message;
  }
}

TEST(Explanations, ScaleAndClockComeWithTheirValue) {
  testing::Streams streams = drive(Terrain::free);
  streams.b = testing::lengthened(streams.b, 0.5);
  const Calibration scaled = calibrate(streams.a, streams.b);
  ASSERT_NE(find(scaled, "scale"), nullptr);
  EXPECT_NEAR(*find(scaled, "scale")->value, 2, 0.01);

  testing::Streams late = drive(Terrain::free);
  late.b = testing::late(late.b, 0.3);
  const Calibration shifted = calibrate(late.a, late.b);
  ASSERT_NE(find(shifted, "clock_offset"), nullptr);
  EXPECT_NEAR(*find(shifted, "clock_offset")->value, -0.3, 0.005);
}

/// A machine that mostly turns in place shows the scale in few of its motions: the others fit any scale.
TEST(Explanations, MillimetresInExchangedColumnsAreNamedBoth) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      testing::Streams streams = drive(terrain, seed);
      for (StampedPose& stamped : streams.b) {
        Pose pose = to_pose(stamped.pose);
        std::swap(pose.translation.x(), pose.translation.y());
        pose.translation *= 1000;
        stamped.pose = to_dual_quaternion(pose);
      }
      const Calibration calibration = calibrate(streams.a, streams.b);
      const Finding *units = find(calibration, "units"), *axes = find(calibration, "axes_b");
      ASSERT_NE(units, nullptr) << seed << ": " << calibration.reason;
      ASSERT_NE(axes, nullptr) << seed << ": " << calibration.reason;
      EXPECT_TRUE(units->certain && axes->certain) << seed;
      EXPECT_EQ(*units->value, 0.001) << seed;
      ASSERT_TRUE(axes->T_a_b);
      EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*axes->T_a_b)).rotation, 0.02) << seed;
    }
}

TEST(Explanations, MillimetresMirroredAtTheOriginMayBeThoseOfEitherStream) {
  testing::Streams streams = drive(Terrain::free);
  for (StampedPose& stamped : streams.b) {
    Pose pose = to_pose(stamped.pose);
    pose.translation *= -1000;
    stamped.pose = to_dual_quaternion(pose);
  }
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding *in_a = find(calibration, "axes_a"), *in_b = find(calibration, "axes_b");
  ASSERT_TRUE(in_a && in_b && find(calibration, "units")) << calibration.reason;
  EXPECT_NEAR(in_a->improvement / in_b->improvement, 1, 0.5) << "one is the other mirrored";
}

TEST(Explanations, AWrongScaleIsNamedWhereFewMotionsShowIt) {
  for (const double noise : {0.003, 0.01})
    for (const double scale : {0.67, 0.95, 1.05, 1.3, 1.5})
      for (const std::uint64_t seed : {1, 2}) {
        const testing::Streams streams = testing::turning_machine(seed, scale, noise);
        const Calibration calibration = calibrate(streams.a, streams.b);
        const Finding* finding = find(calibration, "scale");
        ASSERT_NE(finding, nullptr) << scale << ", " << noise << ": " << calibration.reason;
        EXPECT_TRUE(finding->certain);
        EXPECT_NEAR(*finding->value * scale, 1, 0.01);
        EXPECT_NE(finding->remedy.find("--scale-b auto"), std::string::npos);
        EXPECT_GE(calibration.verdict, Verdict::doubtful) << scale << ", " << noise;
        ASSERT_TRUE(finding->T_a_b);
        const ExtrinsicError error = extrinsic_error(streams.T, to_dual_quaternion(*finding->T_a_b));
        EXPECT_LT(error.rotation, 0.005);
        EXPECT_LT(error.translation, 0.03);
      }
}

TEST(Explanations, ARightScaleIsNotNamedWhereFewMotionsShowIt) {
  for (const double noise : {0.003, 0.01, 0.03})
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
      for (const double scale : {1.0, 1.005}) {
        const testing::Streams streams = testing::turning_machine(seed, scale, noise);
        const Calibration calibration = calibrate(streams.a, streams.b);
        EXPECT_EQ(find(calibration, "scale"), nullptr) << scale << ", " << noise << ", " << seed;
        EXPECT_LE(calibration.verdict, Verdict::incomplete) << calibration.reason;
      }
}

TEST(Explanations, TheRemedyOfAReadingCures) {
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

TEST(Explanations, UnrelatedStreamsAreCalledThat) {
  const testing::Streams one = drive(Terrain::free, 1), other = drive(Terrain::free, 9);
  const Calibration calibration = calibrate(one.a, other.b);
  EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
  EXPECT_NE(find(calibration, "unrelated"), nullptr);
}

/// On roads one extrinsic explains a part of any two drives: most of each motion is straight ahead.
TEST(Explanations, TwoDrivesOnRoadsAreUnrelated) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const testing::Streams one = drive(terrain, seed), other = drive(terrain, seed + 20);
      const Calibration calibration = calibrate(one.a, other.b);
      EXPECT_EQ(calibration.verdict, Verdict::contradictory) << seed << ": " << calibration.reason;
      EXPECT_NE(find(calibration, "unrelated"), nullptr) << seed << ": " << calibration.reason;
    }
}

/// Turned axes of one stream are those of the other one up to the lever arm: one of them is named.
TEST(Explanations, PositionsInAnotherWorldFrameAreNamed) {
  testing::Streams streams = drive(Terrain::free);
  const Eigen::Matrix3d turn = rotation_exp({0.2, -0.1, 0.6}).toRotationMatrix();
  streams.b = testing::with_position_columns(streams.b, turn);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
  EXPECT_TRUE(find(calibration, "axes_a") || find(calibration, "axes_b")) << calibration.reason;
}

TEST(Explanations, AnInvertedStreamContradictsWhicheverOfTheTwoItIs) {
  testing::Streams streams = testing::bounded_drive();
  EXPECT_EQ(calibrate(streams.a, streams.b).verdict, Verdict::good);
  streams.a = testing::inverted(streams.a);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_NE(find(calibration, "inverted_a"), nullptr) << calibration.reason;
  EXPECT_EQ(calibration.verdict, Verdict::contradictory);
}

TEST(Explanations, PositionsMirroredAtTheOriginMayBeThoseOfEitherStream) {
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

TEST(Explanations, AStreamThatStandsStillIsNamed) {
  testing::Streams streams = drive(Terrain::free);
  EXPECT_EQ(find(calibrate(streams.a, streams.b), "frozen_b"), nullptr);
  streams.b = testing::frozen(streams.b, 0.4, 0.7);
  EXPECT_NE(find(calibrate(streams.a, streams.b), "frozen_b"), nullptr);
}

/// An arm whose encoders repeat each pose for two of five seconds; the other sensor has noise.
testing::Streams stopping_arm() {
  testing::Random random(2);
  const Pose T_b{rotation_exp({0.3, -0.2, 0.9}), {0.1, 0.05, 0.2}};
  testing::Streams streams;
  streams.T = to_dual_quaternion(T_b);
  for (int i = 0; i < 1500; ++i) {
    const double t = 0.05 * i, u = 3 * std::floor(t / 5) + std::min(3.0, std::fmod(t, 5));
    const Pose arm{
        rotation_exp({0.6 * std::sin(0.9 * u), 0.5 * std::sin(0.7 * u + 1), 0.8 * std::sin(0.4 * u)}),
        {0.4 * std::sin(0.5 * u), 0.3 * std::sin(0.8 * u + 2), 0.2 * std::sin(1.1 * u)}};
    const auto time_us = static_cast<std::int64_t>(i) * 50'000;
    streams.a.push_back({time_us, canonical_sign(to_dual_quaternion(arm))});
    streams.b.push_back(
        {time_us, canonical_sign(to_dual_quaternion(arm * T_b) *
                                 testing::displacement(random.normal3(1e-3), random.normal3(5e-4)))});
  }
  return streams;
}

TEST(Explanations, AStreamThatStandsStillAtTimesHidesNoOtherMistake) {
  testing::Streams streams = stopping_arm();
  EXPECT_LE(calibrate(streams.a, streams.b).verdict, Verdict::incomplete);
  streams.b = testing::late(streams.b, 2);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::contradictory);
  const Finding* clock = find(calibration, "clock_offset");
  ASSERT_NE(clock, nullptr) << calibration.reason;
  EXPECT_NEAR(*clock->value, -2, 0.05);
}

TEST(Explanations, APositionWithoutHeightIsNamedAndNotGood) {
  testing::Streams streams = drive(Terrain::free);
  streams.b = testing::with_position_columns(streams.b, Eigen::Vector3d(1, 1, 0).asDiagonal());
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_GE(calibration.verdict, Verdict::doubtful);
  EXPECT_NE(find(calibration, "flat_b"), nullptr);
}

/// Wheels know no slopes: x, y and the heading. Its own rotations do not tilt then, those of the other
/// sensor do.
TEST(Explanations, AnOdometryInTwoDimensionsBesideOneThatTiltsIsNamedAndNotGood) {
  testing::Streams streams = drive(Terrain::rough);
  const auto level = [](const Trajectory& poses) {
    return testing::changed(poses, [](const Pose& pose) {
      const Eigen::Vector3d ahead = pose.rotation * Eigen::Vector3d::UnitX();
      return Pose{rotation_exp({0, 0, std::atan2(ahead.y(), ahead.x())}),
                  {pose.translation.x(), pose.translation.y(), 0}};
    });
  };
  const Calibration calibration = calibrate(streams.a, level(streams.a));
  EXPECT_GE(calibration.verdict, Verdict::doubtful);
  const Finding* finding = find(calibration, "flat_b");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_TRUE(finding->certain);
  EXPECT_NE(finding->message.find("a tilts"), std::string::npos) << finding->message;
  // on level ground it is right, whatever the rotations of the other one are wrong by
  for (const double noise : {1e-3, 0.1}) {
    const testing::Streams ground = testing::noisy_drive(Terrain::flat, noise);
    EXPECT_EQ(find(calibrate(ground.a, level(ground.a)), "flat_b"), nullptr) << noise;
  }
}

TEST(Explanations, AStreamGivenTwiceIsNamedAndNotGood) {
  const testing::Streams streams = drive(Terrain::free);
  const Calibration calibration = calibrate(streams.a, streams.a);
  EXPECT_EQ(calibration.verdict, Verdict::doubtful);
  EXPECT_NE(find(calibration, "same_stream"), nullptr);
}

TEST(Explanations, StreamsThatAreInOneFrameAlreadyAreNamed) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    testing::Streams streams = drive(terrain);
    EXPECT_EQ(find(calibrate(streams.a, streams.b), "same_stream"), nullptr);
    streams.b = testing::seen_from(streams.b, streams.T);
    const Calibration calibration = calibrate(streams.a, streams.b);
    const Finding* finding = find(calibration, "same_stream");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_FALSE(finding->certain);  // cameras may sit side by side
    EXPECT_LT(calibration.verdict, Verdict::doubtful);
  }
}

TEST(Explanations, ALeftHandedStreamIsNotGood) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free}) {
    testing::Streams streams = drive(terrain);
    streams.b = testing::mirrored(streams.b);
    EXPECT_NE(calibrate(streams.a, streams.b).verdict, Verdict::good);
  }
}

TEST(Explanations, APartOfAnotherDriveIsFoundAtItsTime) {
  testing::Streams streams = drive(Terrain::free, 1);
  const testing::Streams other = drive(Terrain::free, 9);
  const std::size_t half = streams.b.size() / 2;
  const DualQuaternion start = streams.b[half].pose * conjugate(other.b[half].pose);
  for (std::size_t i = half; i < streams.b.size(); ++i)
    streams.b[i].pose = canonical_sign(normalized(start * other.b[i].pose));
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_GE(calibration.verdict, Verdict::doubtful) << calibration.reason;
  const Finding* finding = find(calibration, "unrelated");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  ASSERT_TRUE(finding->time);
  EXPECT_NEAR(*finding->time, 30, 8);
}

TEST(Explanations, AClockThatIsOffByMoreThanAQuarterOfTheDriveIsNamed) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const double seconds : {25.0, -25.0}) {
      testing::Streams streams = drive(terrain, 3);
      for (StampedPose& stamped : streams.b) stamped.time_us -= std::llround(1e6 * seconds);
      const Calibration calibration = calibrate(streams.a, streams.b);
      const Finding* clock = find(calibration, "clock_offset");
      ASSERT_NE(clock, nullptr) << calibration.reason;
      EXPECT_TRUE(clock->certain);
      EXPECT_NEAR(*clock->value, seconds, 0.01);
    }
}

TEST(Explanations, AGroundPlaneAboveTheSensorIsRefused) {
  SimulationOptions simulation;
  simulation.terrain = Terrain::flat;
  simulation.poses = 401;
  simulation.relative_noise = 0.01;
  simulation.T_vehicle_sensor = {{Eigen::Quaterniond::Identity(), {1, 0, 1.8}},
                                 {rotation_exp({0, 0, 0.5}), {2, 0.3, 1.2}}};
  const std::vector<Trajectory> streams = simulate(simulation);
  CalibrationOptions options;
  options.pairing.mode = Mode::planar;
  options.pairing.plane_a = {{0, 0, 1}, -1.8};
  options.pairing.plane_b = {{0, 0, 1}, -1.2};
  EXPECT_EQ(calibrate(streams[0], streams[1], options).verdict, Verdict::good);

  CalibrationOptions wrong_sign = options;
  wrong_sign.pairing.plane_b.distance = 1.2;
  const Calibration above = calibrate(streams[0], streams[1], wrong_sign);
  EXPECT_NE(find(above, "plane_b"), nullptr);
  EXPECT_EQ(above.verdict, Verdict::contradictory);

  CalibrationOptions downwards = options;
  downwards.pairing.plane_b = {{0, 0, -1}, 1.2};
  EXPECT_NE(find(calibrate(streams[0], streams[1], downwards), "plane_b"), nullptr);

  CalibrationOptions sideways = options;
  sideways.pairing.plane_a = {{1, 0, 0}, -1.8};
  EXPECT_NE(find(calibrate(streams[0], streams[1], sideways), "plane_a"), nullptr);
}

TEST(Explanations, TimesInAnotherUnitAreNamedByAnImpossiblePace) {
  testing::Streams streams = drive(Terrain::free);
  EXPECT_EQ(find(calibrate(streams.a, streams.b), "time_unit"), nullptr);
  for (Trajectory* stream : {&streams.a, &streams.b})
    for (StampedPose& pose : *stream) pose.time_us /= 1000;
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* finding = find(calibration, "time_unit");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_TRUE(finding->certain);
  ASSERT_TRUE(finding->value);
  EXPECT_EQ(*finding->value, 1000);
  EXPECT_EQ(calibration.verdict, Verdict::doubtful) << calibration.reason;
}

/// Jets are fast, and turn little.
TEST(Explanations, AnAircraftIsNoWrongUnitOfTime) {
  const auto streams_at = [](double speed) {
    testing::Streams streams;
    DualQuaternion a, b;
    testing::Random random(1);
    for (int i = 0; i < 1200; ++i) {
      const double t = 0.1 * i;
      const DualQuaternion step =
          testing::displacement(0.1 * Eigen::Vector3d(0.1 * std::sin(0.3 * t), 0.02 * std::sin(0.21 * t),
                                                      0.05 * std::sin(0.11 * t)),
                                {0.1 * speed, 0, 0});
      for (DualQuaternion* pose : {&a, &b})
        *pose = *pose * step * testing::displacement(random.normal3(1e-5), random.normal3(1e-3));
      const auto time_us = static_cast<std::int64_t>(i) * 100'000;
      streams.a.push_back({time_us, canonical_sign(a)});
      streams.b.push_back({time_us, canonical_sign(b)});
    }
    return streams;
  };
  const testing::Streams jet = streams_at(240), in_millimetres = streams_at(8000);
  EXPECT_EQ(find(calibrate(jet.a, jet.b), "time_unit"), nullptr);
  EXPECT_NE(find(calibrate(in_millimetres.a, in_millimetres.b), "time_unit"), nullptr);
}

/// With the coordinates of a map: a thousand kilometres from the origin.
Trajectory on_a_map(Trajectory trajectory) {
  const DualQuaternion shift = to_dual_quaternion(Pose{Eigen::Quaterniond::Identity(), {5e5, 5.4e6, 300}});
  for (StampedPose& pose : trajectory) pose.pose = canonical_sign(shift * pose.pose);
  return trajectory;
}

TEST(Explanations, CoordinatesOfAMapAreNeitherFrozenNorMissing) {
  testing::Streams streams = drive(Terrain::free);
  streams.a = on_a_map(streams.a);
  streams.b = testing::inverted(on_a_map(streams.b));
  const Calibration calibration = calibrate(streams.a, streams.b);
  for (const char* code : {"frozen_a", "frozen_b", "missing_a", "missing_b"})
    EXPECT_EQ(find(calibration, code), nullptr) << code;
  EXPECT_NE(find(calibration, "inverted_b"), nullptr) << calibration.reason;
}

TEST(Explanations, BothInvertedOnAMapIsNotCalledAWrongUnitOfTime) {
  testing::Streams streams = drive(Terrain::free);
  streams.a = testing::inverted(on_a_map(streams.a));
  streams.b = testing::inverted(on_a_map(streams.b));
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(find(calibration, "time_unit"), nullptr);
  const Finding* finding = find(calibration, "inverted_both");
  ASSERT_NE(finding, nullptr) << calibration.reason;
  EXPECT_TRUE(finding->certain);
}

TEST(Explanations, BothInvertedIsNotMentionedWhereMetresSayOtherwise) {
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

TEST(Explanations, TheRemedyOfAUnitNamesTheStreamThatItIsOf) {
  testing::Streams streams = drive(Terrain::free);
  const Finding* finding = nullptr;
  const Calibration of_b = calibrate(streams.a, testing::lengthened(streams.b, 1000));
  ASSERT_NE(finding = find(of_b, "units"), nullptr);
  EXPECT_EQ(finding->remedy, "--scale-b 0.001");
  const Calibration of_a = calibrate(testing::lengthened(streams.a, 1000), streams.b);
  ASSERT_NE(finding = find(of_a, "units"), nullptr);
  EXPECT_EQ(finding->remedy, "--scale 0.001");
}

TEST(Explanations, AreDeterministic) {
  testing::Streams streams = drive(Terrain::rough);
  streams.b = testing::late(streams.b, 0.2);
  const Calibration one = calibrate(streams.a, streams.b), two = calibrate(streams.a, streams.b);
  ASSERT_EQ(one.findings.size(), two.findings.size());
  for (std::size_t i = 0; i < one.findings.size(); ++i) {
    EXPECT_EQ(one.findings[i].message, two.findings[i].message);
    EXPECT_EQ(one.findings[i].improvement, two.findings[i].improvement);
  }
}

}  // namespace
}  // namespace egocal::test_explanations
