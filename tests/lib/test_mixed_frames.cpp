// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Streams whose poses are of two frames of the same body, as of two publishers on one topic.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_mixed_frames {
namespace {

using testing::at_random;
using testing::every;
using testing::with_another_frame;

const Pose apart{Rotation::Identity(), {1, 0.3, 0}};
const Pose turned{rotation_exp({0, 0, 0.07}), Eigen::Vector3d::Zero()};

bool is_mixed_frames(const Finding& finding) {
  return finding.code.starts_with("mixed_frames_");
}

bool names_mixed_frames(const Calibration& calibration) {
  return std::any_of(calibration.findings.begin(), calibration.findings.end(), is_mixed_frames);
}

bool is_certain_of_mixed_frames(const Calibration& calibration) {
  return std::any_of(calibration.findings.begin(), calibration.findings.end(),
                     [](const Finding& finding) { return finding.certain && is_mixed_frames(finding); });
}

testing::Streams with_mixed(testing::Streams streams, char side, const Pose& other,
                            const std::function<bool(std::size_t)>& of_other) {
  Trajectory& wrong = side == 'a' ? streams.a : streams.b;
  wrong = with_another_frame(std::move(wrong), other, of_other);
  return streams;
}

void expect_named(const testing::Streams& streams, char side, const std::string& words) {
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* finding = testing::find(calibration, std::string("mixed_frames_") + side);
  ASSERT_NE(finding, nullptr) << words << side << ": " << calibration.reason;
  EXPECT_TRUE(finding->certain) << words << side;
  EXPECT_NE(finding->message.find(words), std::string::npos) << finding->message;
  EXPECT_EQ(calibration.verdict, Verdict::contradictory) << words << side;
}

TEST(MixedFrames, AreNamedWithTheirStream) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const std::size_t n : {2, 3})
      for (const char side : {'a', 'b'}) {
        expect_named(with_mixed(testing::drive(terrain), side, apart, every(n)), side,
                     n == 2 ? ": 50 %" : ": 33 %");
        expect_named(with_mixed(testing::drive(terrain), side, turned, every(n)), side, " and 4 deg");
      }
}

/// Nothing was said of these, and answers were good and 76 cm off.
TEST(MixedFrames, AreNamedWithoutAPattern) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const char side : {'a', 'b'}) {
      const testing::Streams streams = testing::drive(terrain, 2);
      expect_named(with_mixed(streams, side, apart, at_random(1.0 / 3, 1)), side, " cm and 0.0");
      expect_named(with_mixed(streams, side, turned, at_random(1.0 / 3, 1)), side, " and 4 deg");
    }
}

/// Both publish the poses of a body at rates of their own; the other sensor is measured at still other times.
TEST(MixedFrames, OfTwoRatesAreNamed) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const std::size_t slow : {10, 15}) {
      SimulationOptions options;
      options.terrain = terrain;
      options.rate = 30;
      options.poses = 1801;
      options.relative_noise = 0.01;
      const testing::Streams fast = testing::simulated_drive(options);
      testing::Streams streams{fast.T, {}, {}, {}};
      const Trajectory other = with_another_frame(fast.b, apart, every(1));
      for (std::size_t i = 0; i < fast.b.size(); ++i) {
        if (i % 3 == 1) streams.a.push_back(fast.a[i]);
        if (i % 3 == 0)
          streams.b.push_back(fast.b[i]);
        else if (i % slow == 5)
          streams.b.push_back(other[i]);
      }
      expect_named(streams, 'b', " % of them");
    }
}

/// Of poses single steps hold the noise of both ends, as long motions do.
TEST(MixedFrames, NoiseOnPosesIsNoOtherFrame) {
  for (const double noise : {0.001, 0.01, 0.1})
    for (const std::uint64_t seed : {1, 2, 3}) {
      testing::Streams streams = testing::drive(Terrain::rough, seed);
      testing::Random random(seed);
      for (Trajectory* stream : {&streams.a, &streams.b})
        for (auto& stamped : *stream)
          stamped.pose =
              canonical_sign(stamped.pose * to_dual_quaternion({rotation_exp(random.normal3(0.1 * noise)),
                                                                random.normal3(noise)}));
      EXPECT_FALSE(names_mixed_frames(calibrate(streams.a, streams.b))) << noise << " " << seed;
    }
}

/// Single steps leave a part of the way then.
TEST(MixedFrames, StampsThatAlternateAndHeldValuesAreNoOtherFrame) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    testing::Streams late = testing::drive(terrain);
    for (std::size_t i = 0; i < late.b.size(); i += 2) late.b[i].time_us += 40'000;
    const Calibration of_late = calibrate(late.a, late.b);
    EXPECT_FALSE(is_certain_of_mixed_frames(of_late));
    EXPECT_NE(of_late.verdict, Verdict::contradictory) << of_late.reason;
    for (const std::size_t n : {2, 3}) {
      const testing::Streams right = testing::drive(terrain);
      for (const Trajectory& held :
           {testing::with_held_positions(right.b, n), testing::with_held_rotations(right.b, n)})
        EXPECT_FALSE(names_mixed_frames(calibrate(right.a, held))) << n;
    }
  }
}

/// They leave what the sensor travels meanwhile, always the same at one speed.
TEST(MixedFrames, StampsOfASlowClockAreNoOtherFrame) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const std::int64_t tick : {66'667, 250'000}) {
      testing::Streams streams = testing::drive(terrain);
      streams.b = testing::with_rounded_stamps(std::move(streams.b), tick);
      EXPECT_FALSE(is_certain_of_mixed_frames(calibrate(streams.a, streams.b))) << tick;
    }
}

/// There and back by another offset each time, there and no more back, or by an offset of any size.
TEST(MixedFrames, OutliersJumpsAndVibrationsAreNoOtherFrame) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    const testing::Streams right = testing::drive(terrain);
    testing::Random random(1);
    testing::Streams outliers = right, jumps = right, noisy = right, shaken = right;
    DualQuaternion jumped = to_dual_quaternion({});
    for (std::size_t i = 0; i < right.b.size(); ++i) {
      const auto times = [](const StampedPose& pose, const Pose& T) {
        return canonical_sign(normalized(pose.pose * to_dual_quaternion(T)));
      };
      const Pose any{rotation_exp(random.normal3(0.03)), random.normal3(1)};
      if (random.uniform() < 0.2) outliers.b[i].pose = times(right.b[i], any);
      if (random.uniform() < 0.1) jumped = jumped * to_dual_quaternion(any);
      jumps.b[i].pose = canonical_sign(normalized(jumped * right.b[i].pose));
      noisy.b[i].pose = times(right.b[i], {Rotation::Identity(), {0, 0, random.uniform(-1, 1)}});
      const double at = std::sin(2 * std::numbers::pi * 0.31 * static_cast<double>(i));
      shaken.b[i].pose = times(right.b[i], {rotation_exp({0, 0.03 * at, 0}), {0, 0, 0.1 * at}});
    }
    for (const testing::Streams& streams : {outliers, jumps, noisy, shaken})
      EXPECT_FALSE(names_mixed_frames(calibrate(streams.a, streams.b)));
  }
}

/// A slow stream that is interpolated at the stamps of a fast one.
TEST(MixedFrames, ASlowStreamIsNoneOfTwoFrames) {
  for (const std::size_t slower : {2, 3, 5}) {
    const testing::Streams streams = testing::drive(Terrain::rough);
    Trajectory slow;
    for (std::size_t i = 0; i < streams.b.size(); i += slower) slow.push_back(streams.b[i]);
    EXPECT_FALSE(names_mixed_frames(calibrate(streams.a, slow))) << slower;
    EXPECT_FALSE(names_mixed_frames(calibrate(slow, streams.a))) << slower;
  }
}

// Stamps that are late by turns may look like two frames. Such a finding ended the search, and a mount that
// had turned by 2 deg was not named: the verdict was good.
TEST(MixedFrames, WhatMayBeLateStampsHidesNoMove) {
  SimulationOptions simulation;
  simulation.terrain = Terrain::rough;
  simulation.roughness = 0.2;
  simulation.relative_noise = 0.001;
  simulation.poses = 1201;
  simulation.seed = 3;
  simulation.faults.resize(2);
  const Pose bump{rotation_exp({0, 0, 2 * std::numbers::pi / 180}), Eigen::Vector3d::Zero()};
  simulation.faults[1].mount_changes = {{100, 100, bump}};
  testing::Streams streams = testing::simulated_drive(simulation);
  for (std::size_t i = 1; i < streams.b.size(); i += 2) streams.b[i].time_us += 20'000;
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_GE(calibration.verdict, Verdict::doubtful) << calibration.reason;
  EXPECT_NE(testing::find(calibration, "mount_moved"), nullptr) << calibration.reason;
}

}  // namespace
}  // namespace egocal::test_mixed_frames
