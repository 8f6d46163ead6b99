// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// One coordinate of the positions that is late, as the height of a barometer beside satellite navigation.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "../support/bounded_drive.hpp"
#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "diagnosis/explanations/times/late_column.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_late_column {
namespace {

using testing::find;

/// A coordinate of the positions follows through a filter of the first order.
Trajectory filtered(const Trajectory& given, int column, double time_constant) {
  Trajectory result = given;
  double value = to_pose(given.front().pose).translation[column];
  for (std::size_t i = 1; i < given.size(); ++i) {
    const double seconds = 1e-6 * static_cast<double>(given[i].time_us - given[i - 1].time_us);
    Pose pose = to_pose(given[i].pose);
    value += (pose.translation[column] - value) * (1 - std::exp(-seconds / time_constant));
    pose.translation[column] = value;
    result[i].pose = to_dual_quaternion(pose);
  }
  return result;
}

std::vector<Finding> found_in(const testing::Streams& streams) {
  const DiagnosisOptions options;
  const detail::Evidence evidence = detail::gather(streams.a, streams.b, {}, 0.5, options);
  return detail::late_column(evidence.instants, evidence.given.explained, options);
}

TEST(LateColumn, IsFoundInEitherStream) {
  const testing::Streams given = testing::bounded_drive();
  for (const Side side : {Side::a, Side::b})
    for (int column = 0; column < 3; ++column) {
      testing::Streams streams = given;
      Trajectory& wrong = side == Side::a ? streams.a : streams.b;
      wrong = filtered(wrong, column, 0.5);
      const std::vector<Finding> found = found_in(streams);
      ASSERT_FALSE(found.empty()) << column;
      EXPECT_EQ(found.front().code, side == Side::a ? "late_positions_a" : "late_positions_b") << column;
      EXPECT_FALSE(found.front().certain);
      EXPECT_NEAR(*found.front().value, 0.5, 0.1) << column;
      EXPECT_NE(found.front().message.find(std::string(", ") + "xyz"[column] + ","), std::string::npos)
          << found.front().message;
      EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*found.front().T_a_b)).translation, 0.05);
    }
}

TEST(LateColumn, IsNamedAndWidensWhatIsStated) {
  testing::Streams streams = testing::bounded_drive();
  streams.b = filtered(streams.b, 2, 1);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_NE(find(calibration, "late_positions_b"), nullptr) << calibration.reason;
}

TEST(LateColumn, IsNotFoundInCleanDrives) {
  EXPECT_TRUE(found_in(testing::bounded_drive()).empty());
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
      EXPECT_TRUE(found_in(testing::drive(terrain, seed)).empty()) << seed;
}

// One delay of all three coordinates is what LatePositions finds.
TEST(LateColumn, OfAllThreeIsThatOfTheStream) {
  testing::Streams streams = testing::bounded_drive();
  for (int column = 0; column < 3; ++column) streams.b = filtered(streams.b, column, 0.3);
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* const found = find(calibration, "late_positions_b");
  ASSERT_NE(found, nullptr) << calibration.reason;
  EXPECT_NE(found->message.find("than its rotations"), std::string::npos) << found->message;
}

}  // namespace
}  // namespace egocal::test_late_column
