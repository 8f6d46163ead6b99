// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses that were written with few digits: what these leave unknown of an answer.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/simulated_drive.hpp"
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

std::array<double, 6> stddev_of(const Trajectory& a, const Trajectory& b, const DualQuaternion& T_a_b) {
  const DiagnosisOptions options;
  const double max_gap = PairingOptions().max_gap;
  const detail::MiddlePart part{a, b};
  const detail::Instants instants = detail::synchronised(part.a, part.b, {0, 0, 0}, max_gap);
  const int stride = 10;
  const detail::Motions motions =
      detail::motions_of(instants, {}, {}, stride, options.motions.most, options.motions);
  return detail::rounding_stddev(part, instants, stride, motions, T_a_b, 0, max_gap, options);
}

TEST(Rounding, PosesWithAllDigitsLeaveNothingUnknown) {
  const testing::Streams drive = testing::noisy_drive(Terrain::rough, 0.002);
  for (const double stddev : stddev_of(drive.a, drive.b, drive.T)) EXPECT_EQ(stddev, 0);
}

/// A vehicle turns about one axis and hardly about the others: of three decimals of a quaternion, 0.06
/// degrees, roll and pitch of the answer know a part only.
TEST(Rounding, ThreeDecimalsLeaveSomeOfADegreeUnknown) {
  const testing::Streams drive = testing::noisy_drive(Terrain::rough, 0.002);
  const std::array<double, 6> of_three =
      stddev_of(written_with(drive.a, 3), written_with(drive.b, 3), drive.T);
  const std::array<double, 6> of_five =
      stddev_of(written_with(drive.a, 5), written_with(drive.b, 5), drive.T);
  double most = 0;
  for (std::size_t i = 3; i < 6; ++i) {
    most = std::max(most, of_three[i]);
    EXPECT_LT(of_three[i], 0.01);
    EXPECT_LT(of_five[i], 1e-4);
  }
  EXPECT_GT(most, 1e-5);
}

}  // namespace
}  // namespace egocal::test_rounding
