// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A gyroscope whose bias wanders, beside positions of another sensor: the deviations contain what the heading
// is wrong by.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "../support/findings.hpp"
#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_wandering_headings {
namespace {

using testing::find;

/// The headings of b turn away at a rate that is remembered for this long [s].
Trajectory with_wandering_headings(const Trajectory& right, double rate_deg, double memory,
                                   std::uint64_t seed) {
  testing::Random random(seed);
  // the vertical of the vehicle, in the start frame of b
  const Eigen::Vector3d up = testing::T_vehicle_b.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  Trajectory wrong = right;
  double bias = random.normal(), heading = 0;
  for (std::size_t i = 1; i < right.size(); ++i) {
    const double dt = 1e-6 * static_cast<double>(right[i].time_us - right[i - 1].time_us);
    const double kept = std::exp(-dt / memory);
    bias = kept * bias + std::sqrt(1 - kept * kept) * random.normal();
    heading += dt * rate_deg * std::numbers::pi / 180 * bias;
    Pose pose = to_pose(right[i].pose);
    pose.rotation = rotation_exp(heading * up) * pose.rotation;
    wrong[i].pose = to_dual_quaternion(pose);
  }
  return wrong;
}

/// Largest error of the answer in its standard deviations, where it is observable.
double in_stddevs(const Calibration& calibration, const DualQuaternion& truth) {
  const auto error = detail::frame_a_difference(truth, to_dual_quaternion(calibration.T_a_b));
  double most = 0;
  for (std::size_t i = 0; i < 6; ++i)
    if (calibration.observability.observable[i])
      most =
          std::max(most, std::abs(error[static_cast<Eigen::Index>(i)]) / calibration.observability.stddev[i]);
  return most;
}

/// Or they are taken for a mount that moved, which contradicts the answer.
TEST(WanderingHeadings, AreInTheDeviations) {
  int stated = 0;
  SimulationOptions options;
  options.poses = 1201;
  options.relative_noise = 0.005;
  options.speed_variation = 0.3;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    options.seed = seed;
    testing::Streams wrong = testing::simulated_drive(options);
    wrong.b = with_wandering_headings(wrong.b, 0.1, 30, seed + 10);
    const Calibration calibration = calibrate(wrong.a, wrong.b);
    const Finding* const moved = find(calibration, "mount_moved");
    EXPECT_TRUE(moved || find(calibration, "turning_drift_b")) << seed << " " << calibration.reason;
    EXPECT_GT(calibration.verdict, Verdict::good) << seed << " " << calibration.reason;
    if (moved && moved->certain) continue;
    ++stated;
    EXPECT_LT(in_stddevs(calibration, wrong.T), 4) << seed << " " << calibration.reason;
  }
  EXPECT_GE(stated, 2);
}

TEST(WanderingHeadings, OfRightStreamsAreNotNamed) {
  for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const testing::Streams right = testing::drive(terrain, seed);
      const Calibration calibration = calibrate(right.a, right.b);
      EXPECT_EQ(find(calibration, "turning_drift_a"), nullptr) << seed;
      EXPECT_EQ(find(calibration, "turning_drift_b"), nullptr) << seed;
    }
}

}  // namespace
}  // namespace egocal::test_wandering_headings
