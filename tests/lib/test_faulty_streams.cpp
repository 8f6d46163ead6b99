// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Streams that stand still, lack a part or are given twice, and planes that cannot be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"

namespace egocal::test_faulty_streams {
namespace {

using testing::drive;
using testing::find;

TEST(FaultyStreams, StreamsWithoutPositionsOrRotationsAreRefused) {
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

TEST(FaultyStreams, AStreamThatStandsStillIsNamed) {
  testing::Streams streams = drive(Terrain::free);
  EXPECT_EQ(find(calibrate(streams.a, streams.b), "frozen_b"), nullptr);
  streams.b = testing::frozen(streams.b, 0.4, 0.7);
  EXPECT_NE(find(calibrate(streams.a, streams.b), "frozen_b"), nullptr);
}

// "frozen_b" counted as what explains the drive: answers were up to 85 degrees off, and incomplete or good.
TEST(FaultyStreams, AStreamThatFreezesHidesNoOtherMistake) {
  const std::map<std::string, std::function<Trajectory(const Trajectory&)>> mistakes{
      {"inverted_b", testing::inverted},
      {"quaternion_order_b", testing::scalar_first},
      {"axes_b", testing::mirrored},
      {"scale", [](const Trajectory& right) { return testing::lengthened(right, 0.37); }}};
  for (const auto& [code, make] : mistakes)
    for (const Terrain terrain : {Terrain::rough, Terrain::free})
      for (const std::uint64_t seed : {1, 2}) {
        testing::Streams streams = drive(terrain, seed);
        streams.b = make(testing::frozen(streams.b, 0.4, 0.65));
        const Calibration calibration = calibrate(streams.a, streams.b);
        EXPECT_NE(find(calibration, "frozen_b"), nullptr) << code << seed;
        const Finding* finding = find(calibration, code);
        ASSERT_NE(finding, nullptr) << code << seed << calibration.reason;
        EXPECT_TRUE(finding->certain) << code << seed;
        EXPECT_EQ(calibration.verdict, Verdict::contradictory) << code << seed;
      }
}

// A parked vehicle with noise of a tenth of a millimetre: "111 % of the typical motion is not explained".
TEST(FaultyStreams, AVehicleThatMostlyStandsAndGoesStraightContradictsNothing) {
  testing::Random random(3);
  const DualQuaternion T = testing::displacement({0, 0, 0.5}, {0.4, 0.1, 0.2});
  testing::Streams streams;
  for (int i = 0; i < 400; ++i) {
    const double way = 0.05 * std::max(0, i - 300);
    const DualQuaternion vehicle = testing::displacement(Eigen::Vector3d::Zero(), {way, 0, 0});
    const auto noisy = [&random](const DualQuaternion& pose) {
      return canonical_sign(pose * testing::displacement(random.normal3(2e-5), random.normal3(1e-4)));
    };
    streams.a.push_back({100'000 * static_cast<std::int64_t>(i), noisy(vehicle)});
    streams.b.push_back({100'000 * static_cast<std::int64_t>(i), noisy(vehicle * T)});
  }
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::incomplete) << calibration.reason;
  EXPECT_NE(find(calibration, "too_little_motion"), nullptr);
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

TEST(FaultyStreams, AStreamThatStandsStillAtTimesHidesNoOtherMistake) {
  testing::Streams streams = stopping_arm();
  EXPECT_LE(calibrate(streams.a, streams.b).verdict, Verdict::incomplete);
  streams.b = testing::late(streams.b, 2);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::contradictory);
  const Finding* clock = find(calibration, "clock_offset");
  ASSERT_NE(clock, nullptr) << calibration.reason;
  EXPECT_NEAR(*clock->value, -2, 0.05);
}

TEST(FaultyStreams, APositionWithoutHeightIsNamedAndNotGood) {
  testing::Streams streams = drive(Terrain::free);
  streams.b = testing::with_position_columns(streams.b, Eigen::Vector3d(1, 1, 0).asDiagonal());
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_GE(calibration.verdict, Verdict::doubtful);
  EXPECT_NE(find(calibration, "flat_b"), nullptr);
}

/// Wheels know no slopes: x, y and the heading. Its own rotations do not tilt then, those of the other
/// sensor do.
TEST(FaultyStreams, AnOdometryInTwoDimensionsBesideOneThatTiltsIsNamedAndNotGood) {
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

TEST(FaultyStreams, AStreamGivenTwiceIsNamedAndNotGood) {
  const testing::Streams streams = drive(Terrain::free);
  const Calibration calibration = calibrate(streams.a, streams.a);
  EXPECT_EQ(calibration.verdict, Verdict::doubtful);
  EXPECT_NE(find(calibration, "same_stream"), nullptr);
}

TEST(FaultyStreams, StreamsThatAreInOneFrameAlreadyAreNamed) {
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

TEST(FaultyStreams, AGroundPlaneAboveTheSensorIsRefused) {
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

}  // namespace
}  // namespace egocal::test_faulty_streams
