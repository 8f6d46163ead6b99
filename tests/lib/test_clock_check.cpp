// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Clocks that differ by a few milliseconds on a machine whose angles have fixed phases.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../support/measured_body.hpp"
#include "egocal/calibrate.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_clock_check {
namespace {

using testing::BodyPath, testing::body_step, testing::measured, testing::Sensor, testing::Streams;

struct Walk {
  double late = 0;  ///< of b's stamps [s]
  double rate_a = 10, rate_b = 20;
  std::uint64_t seed = 1;
};

/// Two steps in 0.7 s: roll, pitch and yaw are harmonics with phases of their own, the same in every step.
Streams walking_machine(const Walk& walk) {
  constexpr double seconds = 60, gait = 2 * std::numbers::pi / 0.7;  // [s, rad/s]
  testing::Random random(walk.seed);
  double phases[5], turns[2];
  for (double& phase : phases) phase = random.uniform(0, 2 * std::numbers::pi);
  for (double& turn : turns) turn = random.uniform(0.1, 0.25);
  BodyPath body;
  double x = 0, y = 0;
  for (int i = 0; i * body_step < seconds + 1; ++i) {
    const double t = i * body_step, way = 0.6 * std::sin(turns[0] * t) + 0.8 * std::sin(turns[1] * t + 1);
    x += 1.2 * body_step * std::cos(way);
    y += 1.2 * body_step * std::sin(way);
    const double yaw = way + 0.06 * std::sin(gait * t + phases[0]),
                 roll = 0.05 * std::sin(gait * t + phases[1]),
                 pitch = 0.03 * std::sin(2 * gait * t + phases[2]),
                 sway = 0.03 * std::sin(gait * t + phases[3]),
                 heave = 0.02 * std::sin(2 * gait * t + phases[4]) + 0.05 * std::sin(0.2 * t);
    body.push_back({rotation_exp({0, 0, yaw}) * rotation_exp({0, pitch, 0}) * rotation_exp({roll, 0, 0}),
                    {x - sway * std::sin(way), y + sway * std::cos(way), heave}});
  }
  Streams streams;
  streams.T = to_dual_quaternion(inverse(testing::T_vehicle_a) * testing::T_vehicle_b);
  streams.a = measured(random, body, seconds, {testing::T_vehicle_a, walk.rate_a, 0, 0, 5e-4, 1e-3});
  streams.b =
      measured(random, body, seconds, {testing::T_vehicle_b, walk.rate_b, 0.017, walk.late, 5e-4, 1e-3});
  return streams;
}

const Finding* clock_offset(const Calibration& calibration) {
  for (const Finding& finding : calibration.findings)
    if (finding.code == "clock_offset" && finding.certain) return &finding;
  return nullptr;
}

double worst_in_deviations(const Streams& streams, const Calibration& found) {
  const detail::Vector6d error = detail::frame_a_difference(streams.T, to_dual_quaternion(found.T_a_b));
  double worst = 0;
  for (std::size_t i = 0; i < 6; ++i)
    if (found.observability.observable[i])
      worst = std::max(worst, std::abs(error[static_cast<Eigen::Index>(i)]) / found.observability.stddev[i]);
  return worst;
}

// Before, 2 ms put a walking machine up to 19 of its standard deviations off, with no finding.
TEST(ClockCheck, AWalkingMachineThatIsLateIsNamed) {
  int named = 0;
  for (const double late : {2e-3, -4e-3})
    for (const auto& [rate_a, rate_b] : {std::pair{10.0, 20.0}, std::pair{50.0, 15.0}})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Streams streams = walking_machine({late, rate_a, rate_b, seed});
        CalibrationOptions motions_alone;
        motions_alone.diagnosis.enabled = false;
        const Calibration plain = calibrate(streams.a, streams.b, motions_alone),
                          found = calibrate(streams.a, streams.b);
        const double without = worst_in_deviations(streams, plain),
                     with = worst_in_deviations(streams, found);
        std::printf(
            "%g ms late, %g and %g Hz: off by %.1f standard deviations of the motions, %.1f as stated\n",
            1e3 * late, rate_a, rate_b, without, with);
        EXPECT_LT(with, 4);
        const Finding* finding = clock_offset(found);
        if (!finding) {
          EXPECT_LT(without, 4);
          continue;
        }
        ++named;
        EXPECT_NEAR(finding->value.value(), -late, 5e-4);
        ASSERT_TRUE(finding->T_a_b);
        const detail::Vector6d rest =
            detail::frame_a_difference(streams.T, to_dual_quaternion(*finding->T_a_b));
        EXPECT_LT(rest.tail<3>().norm(), 0.005);
      }
  EXPECT_GE(named, 9);  // of 12
}

TEST(ClockCheck, ClocksThatAgreeAreNotNamed) {
  for (const auto& [rate_a, rate_b] : {std::pair{10.0, 20.0}, std::pair{50.0, 15.0}})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const Streams streams = walking_machine({0, rate_a, rate_b, seed});
      const Calibration found = calibrate(streams.a, streams.b);
      EXPECT_EQ(clock_offset(found), nullptr) << rate_a << " and " << rate_b << " Hz, seed " << seed;
      EXPECT_LE(found.verdict, Verdict::incomplete) << found.reason;
    }
}

/// A body that turns freely and nearly evenly about its centre. noise: of each motion, as a part of the
/// typical one [rad per rad, m per rad].
Streams tumbling_body(std::uint64_t seed, double noise) {
  constexpr double seconds = 45, rate = 15;  // [s, Hz]
  testing::Random random(seed);
  const Eigen::Vector3d inertia(1, 1.2 + random.uniform(), 2.2 + random.uniform());
  Eigen::Vector3d turning = random.normal3(0.3);
  BodyPath body{{}};
  for (int i = 1; i * body_step < seconds + 1; ++i) {
    const Eigen::Vector3d momentum = inertia.cwiseProduct(turning);
    turning += body_step * momentum.cross(turning).cwiseQuotient(inertia);
    body.push_back(
        {(body.back().rotation * rotation_exp(body_step * turning)).normalized(), Eigen::Vector3d::Zero()});
  }
  const Pose on_a{rotation_exp({0.3, -0.2, 0.1}), {0.8, 0.3, 0.2}},
      on_b{rotation_exp({0.5, 0.8, -0.4}), {-0.4, 0.9, -0.6}};
  Streams streams;
  streams.T = to_dual_quaternion(inverse(on_a) * on_b);
  const double of_motion = noise * turning.norm() / rate;
  streams.a = measured(random, body, seconds, {on_a, rate, 0, 0, of_motion, of_motion});
  streams.b = measured(random, body, seconds, {on_b, rate, 0.013, 0, of_motion, of_motion});
  return streams;
}

// 0.08 s were certain, by five and eight standard deviations, since interpolated poses have less noise.
TEST(ClockCheck, ATumblingBodyWhoseClocksAgreeIsNotNamed) {
  for (const std::uint64_t seed : {1, 8}) {
    const Streams streams = tumbling_body(seed, 0.06);
    EXPECT_EQ(clock_offset(calibrate(streams.a, streams.b)), nullptr) << seed;
  }
}

}  // namespace
}  // namespace egocal::test_clock_check
