// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses that were filled in where a sensor had none.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_filled_gaps {
namespace {

using testing::drive;
using testing::find;

enum class Fill { straight_lines, last_velocity, last_position };

/// Poses [begin, begin + count) of three gaps.
Trajectory filled(const Trajectory& right, Fill fill) {
  Trajectory result = right;
  const std::size_t n = right.size(), count = n / 12;
  for (const std::size_t begin : {n / 8, n / 2, 3 * n / 4}) {
    const Pose from = to_pose(right[begin - 1].pose), before = to_pose(right[begin - 2].pose),
               to = to_pose(right[begin + count].pose);
    for (std::size_t i = 0; i < count; ++i) {
      const double part = static_cast<double>(i + 1) / static_cast<double>(count + 1);
      const double steps = static_cast<double>(i + 1);
      Pose pose = to_pose(right[begin + i].pose);
      if (fill == Fill::straight_lines)
        pose = {from.rotation.slerp(part, to.rotation),
                from.translation + part * (to.translation - from.translation)};
      else if (fill == Fill::last_velocity)
        pose = {from.rotation, from.translation + steps * (from.translation - before.translation)};
      else
        pose.translation = from.translation;
      result[begin + i].pose = canonical_sign(to_dual_quaternion(pose));
    }
  }
  return result;
}

TEST(FilledGaps, AreNamedInEitherStream) {
  for (const Fill fill : {Fill::straight_lines, Fill::last_velocity, Fill::last_position})
    for (const std::uint64_t seed : {1, 2}) {
      const testing::Streams right = drive(Terrain::free, seed);
      for (const bool in_a : {false, true}) {
        const std::string where = std::to_string(seed) + (in_a ? " a" : " b");
        const Calibration calibration =
            in_a ? calibrate(filled(right.a, fill), right.b) : calibrate(right.a, filled(right.b, fill));
        const Finding* finding = find(calibration, in_a ? "filled_a" : "filled_b");
        ASSERT_NE(finding, nullptr) << where << calibration.reason;
        EXPECT_TRUE(finding->certain);
        EXPECT_EQ(find(calibration, "mount_moved"), nullptr) << where;
        EXPECT_NE(finding->message.find("2 times more"), std::string::npos) << finding->message;
        EXPECT_LT(extrinsic_error(right.T, to_dual_quaternion(calibration.T_a_b)).rotation, 0.02) << where;
      }
    }
}

/// A sensor that really moves evenly agrees with the other one.
TEST(FilledGaps, EvenMotionIsNone) {
  Trajectory a, b;
  const Pose T{rotation_exp({0.1, 0.2, -0.3}), {1, 0.5, 0.2}};
  Pose here;
  for (int i = 0; i < 900; ++i) {
    const double rate = i / 100 % 2 == 0 ? 0.05 : 0.3 * std::sin(0.05 * i);
    const double noise = 2e-3 * std::sin(12.9898 * i) + 2e-3 * std::sin(78.233 * i);
    here = here * Pose{rotation_exp({0.1 * rate, 0.2 * rate * std::sin(0.013 * i), 0.1 * rate}), {0.3, 0, 0}};
    a.push_back({i * 100'000, canonical_sign(to_dual_quaternion(here))});
    Pose of_b = here * T;
    of_b.translation += Eigen::Vector3d(noise, -noise, noise);
    b.push_back({i * 100'000, canonical_sign(to_dual_quaternion(of_b))});
  }
  const Calibration calibration = calibrate(a, b);
  EXPECT_EQ(find(calibration, "filled_a"), nullptr) << calibration.reason;
  EXPECT_EQ(find(calibration, "filled_b"), nullptr) << calibration.reason;
}

/// Wheels that turn a robot in place keep its position to rounding, and slip: its rotations are off by more
/// than while it drives straight on.
TEST(FilledGaps, TurningInPlaceIsNone) {
  for (const int seed : {1, 2}) {
    const Pose T{rotation_exp({0.02, -0.03, 0.4}), {0.4, 0.1, 0.3}};
    Trajectory a, b;
    Pose here, measured;
    for (int i = 0; i < 1200; ++i) {
      const bool turns = i / 60 % 2 == 1;
      const double noise = std::sin(12.9898 * i + seed) + std::sin(78.233 * i);
      const double turn = turns ? 0.03 * (i / 120 % 2 == 0 ? 1 : -1) : 1e-4 * noise;
      const double way = turns ? 0 : 0.05 + 1e-4 * noise;
      here = here * Pose{rotation_exp({0, 0, turn}), {way, 0, 0}};
      measured = measured * Pose{rotation_exp({0, 0, turns ? 1.03 * turn : turn}), {way, 0, 0}};
      a.push_back({i * 50'000, canonical_sign(to_dual_quaternion(measured))});
      const Pose of_b = here * T;
      b.push_back(
          {i * 50'000,
           canonical_sign(to_dual_quaternion(
               Pose{(of_b.rotation * rotation_exp({2e-4 * noise, -2e-4 * noise, 2e-4 * noise})).normalized(),
                    of_b.translation + 1e-3 * noise * Eigen::Vector3d(1, -1, 1)}))});
    }
    const Calibration calibration = calibrate(a, b);
    EXPECT_EQ(find(calibration, "filled_a"), nullptr) << calibration.reason;
    EXPECT_EQ(find(calibration, "filled_b"), nullptr) << calibration.reason;
  }
}

}  // namespace
}  // namespace egocal::test_filled_gaps
