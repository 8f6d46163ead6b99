// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses that were written with few digits: what these leave unknown of an answer.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "../support/simulated_drive.hpp"
#include "diagnosis/motions/answer_change.hpp"
#include "diagnosis/verdict/rounding.hpp"

namespace egocal::test_rounding {
namespace {

Trajectory written_with(Trajectory poses, int decimals) {
  const double step = std::pow(10, -decimals);
  const auto write = [step](double x) { return step * std::round(x / step); };
  for (StampedPose& stamped : poses) {
    const Pose pose = to_pose(stamped.pose);
    const Eigen::Vector4d q = pose.rotation.coeffs().unaryExpr(write);
    stamped.pose = canonical_sign(to_dual_quaternion(
        Pose{Rotation(Eigen::Vector4d(q.normalized())), pose.translation.unaryExpr(write)}));
  }
  return poses;
}

/// The answer is taken from motions of one instant and of this many.
constexpr int stride = 10;

detail::Instants instants_of(const Trajectory& a, const Trajectory& b) {
  return detail::synchronised(a, b, {0, 0, 0}, PairingOptions().max_gap);
}

std::array<double, 6> stddev_of(const Trajectory& a, const Trajectory& b, const DualQuaternion& T_a_b) {
  const DiagnosisOptions options;
  const detail::MiddlePart part{a, b};
  const detail::Instants instants = instants_of(part.a, part.b);
  const detail::Motions motions =
      detail::motions_of(instants, {}, {}, stride, options.motions.most, options.motions);
  return detail::rounding_stddev(part, instants, stride, motions, T_a_b, 0, PairingOptions().max_gap,
                                 options);
}

/// What three decimals do to a coordinate of the answer (x y z roll pitch yaw), in what is stated of it and
/// what is chance in the parts of a drive: root mean squares over drives.
double rms_z(Eigen::Index coordinate, double noise, int drives) {
  AnswerChangeOptions change = DiagnosisOptions().change;
  change.motions = detail::RoundingOptions().motions;
  change.longer = stride;
  double squares = 0, stated = 0;
  for (int seed = 1; seed <= drives; ++seed) {
    SimulationOptions options;
    options.terrain = Terrain::rough;
    options.poses = 301;
    options.relative_noise = noise;
    options.seed = static_cast<std::uint64_t>(seed);
    const testing::Streams drive = testing::simulated_drive(options);
    const Trajectory a = written_with(drive.a, 3), b = written_with(drive.b, 3);
    const std::optional<detail::AnswerChange> done =
        detail::answer_change(instants_of(drive.a, drive.b), instants_of(a, b), drive.T, change);
    if (!done) return 0;
    const double stddev = stddev_of(a, b, drive.T)[static_cast<std::size_t>(coordinate)];
    squares += done->size[coordinate] * done->size[coordinate];
    stated += stddev * stddev + done->variance[coordinate];
  }
  return std::sqrt(squares / stated);
}

TEST(Rounding, PosesWithAllDigitsLeaveNothingUnknown) {
  const testing::Streams drive = testing::noisy_drive(Terrain::rough, 0.002);
  for (const double stddev : stddev_of(drive.a, drive.b, drive.T)) EXPECT_EQ(stddev, 0);
}

/// A vehicle turns about one axis and hardly about the others: of three decimals of a quaternion, 0.03
/// degrees a pose, the answer knows a part only. Not less than where all poses of both were rounded alike.
TEST(Rounding, ThreeDecimalsLeaveSomeOfADegreeUnknown) {
  const testing::Streams drive = testing::noisy_drive(Terrain::rough, 0.002);
  const std::array<double, 6> of_three =
      stddev_of(written_with(drive.a, 3), written_with(drive.b, 3), drive.T);
  const std::array<double, 6> of_five =
      stddev_of(written_with(drive.a, 5), written_with(drive.b, 5), drive.T);
  const double alike = 2 * 1e-3 / std::sqrt(12.0) * std::sqrt(2.0);  // of both [rad]
  double most = 0;
  for (std::size_t i = 3; i < 6; ++i) {
    most = std::max(most, of_three[i]);
    EXPECT_LT(of_three[i], alike);
    EXPECT_LT(of_five[i], 1e-2 * alike);
  }
  EXPECT_GT(most, 1e-2 * alike);
}

/// Rounding is noise on rotations, which shortens a lever arm: it moves the height the same way in all
/// drives. The chance of 24 drives is a seventh. Where that was counted as if it were linear this was 0.45
/// and 0.66.
TEST(Rounding, WhatIsStatedOfTheHeightIsWhatItIsOffBy) {
  for (const double noise : {0.0005, 0.002}) {
    const double z = rms_z(2, noise, 24);
    EXPECT_GT(z, 0.8) << noise;
    EXPECT_LT(z, 1.2) << noise;
  }
}

}  // namespace
}  // namespace egocal::test_rounding
