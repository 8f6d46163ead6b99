// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A sensor on a trailer: where the curvature is steady, the trailer and the car move as one body.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "../support/bounded_drive.hpp"
#include "../support/findings.hpp"
#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "diagnosis/explanations/times/late_turning.hpp"
#include "diagnosis/streams/contradicting_runs.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_towed_part {
namespace {

using testing::displacement;
using testing::find;

struct Towing {
  double hitch = 1;      ///< behind the axle of the car [m]
  double length = 3;     ///< from the hitch to the axle of the trailer [m]
  double turn_in = 1.5;  ///< that a change of the curvature takes [s]
};

/// A minute at 10 Hz and 11 m/s: each four seconds another curvature, and slopes that both bodies follow.
testing::Streams towed(std::uint64_t seed, const Towing& towing, double noise) {
  constexpr double period = 0.1, speed = 11, steady = 4;
  constexpr int fine = 20;  // steps of the simulation between two poses
  testing::Random random(seed);
  const DualQuaternion T_a = displacement({0.02, -0.01, 0.4}, {0.5, 0.3, 0.8}),
                       T_b = displacement({0.03, 0.02, -0.3}, {0.2, -0.5, 0.6});
  testing::Streams streams;
  streams.T = conjugate(T_a) * displacement({0, 0, 0}, {-towing.hitch - towing.length, 0, 0}) * T_b;
  double x = 0, y = 0, yaw = 0, behind = 0, from = 0, to = 0, next = 0;
  DualQuaternion last_a, last_b, pose_a, pose_b;
  const auto measured = [&](const DualQuaternion& motion) {
    return motion * displacement(random.normal3(noise * 0.1),
                                 random.normal3(noise * to_pose(motion).translation.norm()));
  };
  for (int i = 0; i <= 600 * fine; ++i) {
    const double step = period / fine, t = i * step;
    if (t >= next) {
      from = to;
      to = random.uniform(-0.06, 0.06);
      next += steady;
    }
    const double since = std::min(1.0, (t - (next - steady)) / towing.turn_in);
    const double curvature = from + (to - from) * 0.5 * (1 - std::cos(std::numbers::pi * since));
    if (i % fine == 0) {
      const DualQuaternion slope = displacement({0, 0.05 * std::sin(0.7 * t), 0}, {0, 0, 0}) *
                                   displacement({0.03 * std::sin(1.1 * t), 0, 0}, {0, 0, 0});
      const double hitch_x = x - towing.hitch * std::cos(yaw), hitch_y = y - towing.hitch * std::sin(yaw);
      const DualQuaternion car =
          displacement({0, 0, 0}, {x, y, 0}) * displacement({0, 0, yaw}, {0, 0, 0}) * slope;
      const DualQuaternion trailer =
          displacement({0, 0, 0}, {hitch_x - towing.length * std::cos(behind),
                                   hitch_y - towing.length * std::sin(behind), 0}) *
          displacement({0, 0, behind}, {0, 0, 0}) * slope;
      const DualQuaternion a = car * T_a, b = trailer * T_b;
      if (i > 0) {
        pose_a = pose_a * measured(conjugate(last_a) * a);
        pose_b = pose_b * measured(conjugate(last_b) * b);
      }
      last_a = a;
      last_b = b;
      const auto time_us = static_cast<std::int64_t>(std::llround(1e6 * t));
      streams.a.push_back({time_us, canonical_sign(normalized(pose_a))});
      streams.b.push_back({time_us, canonical_sign(normalized(pose_b))});
    }
    // the hitch moves with the car, the axle of the trailer does not slip aside
    const double aside =
        speed * std::sin(yaw - behind) - towing.hitch * speed * curvature * std::cos(yaw - behind);
    behind += step * aside / towing.length;
    x += step * speed * std::cos(yaw);
    y += step * speed * std::sin(yaw);
    yaw += step * speed * curvature;
  }
  return streams;
}

detail::Motions of_four(const detail::Instants& instants) {
  const MotionSampleOptions sample;
  return detail::motions_of(instants, {}, {}, 4, sample.most, sample);
}

TEST(TowedPart, IsNeverGood) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const testing::Streams streams = towed(seed, {}, 0.002);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_GE(calibration.verdict, Verdict::doubtful) << seed << ": " << calibration.reason;
  }
}

TEST(TowedPart, ContradictsTheRestWhereTheCurvatureChanges) {
  const testing::Streams streams = towed(1, {}, 0.002);
  const detail::Instants instants = detail::synchronised(streams.a, streams.b, {}, 0.5);
  const Calibration calibration = calibrate(streams.a, streams.b);
  const detail::ContradictingRuns found =
      detail::contradicting_runs(of_four(instants), instants.period, calibration.T_a_b);
  EXPECT_GE(found.runs, 5u);
  EXPECT_GT(found.part, 0.1);
  EXPECT_LT(found.part, 0.7);
}

TEST(TowedPart, IsNotSuspectedInCleanDrives) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const testing::Streams streams = testing::drive(Terrain::free, seed);
    const detail::Instants instants = detail::synchronised(streams.a, streams.b, {}, 0.5);
    EXPECT_EQ(detail::contradicting_runs(of_four(instants), instants.period, to_pose(streams.T)).runs, 0u)
        << seed;
  }
}

detail::Evidence gathered(const testing::Streams& streams) {
  return detail::gather(streams.a, streams.b, {}, 0.5, DiagnosisOptions());
}

/// A cart of a metre turns in and out within a tenth of a second: too little for motions that contradict.
constexpr Towing cart{0.3, 0.8, 3};

TEST(TowedPart, TurnsLaterAboutOneAxis) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const testing::Streams streams = towed(seed, cart, 0.002);
    const detail::Evidence evidence = gathered(streams);
    const std::optional<detail::LateTurning> found =
        detail::late_turning(evidence.instants, evidence.given.explained);
    ASSERT_TRUE(found) << seed;
    EXPECT_EQ(found->side, Side::b);
    EXPECT_NEAR(found->seconds, (cart.hitch + cart.length) / 11, 0.02) << seed;
    EXPECT_LT(std::abs(found->others), 0.5 * found->seconds) << seed;
    // the answer is that of the axle of the car; with late rotations it is the place of the sensor
    EXPECT_GT(extrinsic_error(streams.T, found->T_a_b_as_given).translation, 0.8) << seed;
    EXPECT_LT(extrinsic_error(streams.T, found->T_a_b).translation, 0.4) << seed;
  }
}

TEST(TowedPart, OfAMetreIsNamed) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const testing::Streams streams = towed(seed, cart, 0.002);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_GE(calibration.verdict, Verdict::doubtful) << seed << ": " << calibration.reason;
    const Finding* const moved = find(calibration, "mount_moved");
    ASSERT_NE(moved, nullptr) << seed;
    EXPECT_FALSE(moved->certain);
    EXPECT_NE(moved->message.find("about one axis b turns about"), std::string::npos) << moved->message;
  }
}

// All axes are late then, and the clock is what is named.
TEST(TowedPart, IsNotAClockThatDiffers) {
  testing::Streams streams = towed(1, cart, 0.002);
  streams.b = streams.a;
  for (StampedPose& pose : streams.b) pose.time_us += 50'000;
  const detail::Evidence evidence = gathered(streams);
  EXPECT_FALSE(detail::late_turning(evidence.instants, evidence.given.explained));
}

TEST(TowedPart, DoesNotTurnLaterInCleanDrives) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const detail::Evidence evidence = gathered(testing::drive(terrain, seed));
      EXPECT_FALSE(detail::late_turning(evidence.instants, evidence.given.explained)) << seed;
    }
}

/// The mounting of one sensor turns to and fro: the rotations of the drive contradict for half a second each.
TEST(TowedPart, WordsTheRuns) {
  testing::Streams streams = testing::bounded_drive();
  for (std::size_t i = 0; i < streams.b.size(); ++i)
    if (i % 100 < 20)
      streams.b[i].pose = normalized(streams.b[i].pose *
                                     displacement({0, 0, 0.01 * static_cast<double>(i % 100)}, {0, 0, 0}));
  std::vector<Finding> findings;
  const detail::Instants instants = detail::synchronised(streams.a, streams.b, {}, 0.5);
  detail::name_contradicting_runs(instants, of_four(instants), to_pose(streams.T), MotionSampleOptions(),
                                  findings);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings.front().code, "mount_moved");
  EXPECT_FALSE(findings.front().certain);
  EXPECT_NE(findings.front().message.find("parts of the drive"), std::string::npos);
  // what is certain explains them
  findings.front().certain = true;
  detail::name_contradicting_runs(instants, of_four(instants), to_pose(streams.T), MotionSampleOptions(),
                                  findings);
  EXPECT_EQ(findings.size(), 1u);
}

}  // namespace
}  // namespace egocal::test_towed_part
