// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The time axis of the figures of a report, and paths of several drives. Drives that are appended are an hour
// apart: they were slivers at the ends of the axis, and a line joined their paths.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "report/drawn_time.hpp"
#include "report/series.hpp"

namespace egocal::test_drawn_time {
namespace {

using tools::DrawnTime;
using tools::Map;

constexpr std::int64_t hour_us = 3'600'000'000;

/// Straight ahead at 1 m/s, a pose a second, from a place of its own.
void drive(std::int64_t begin_us, int poses, const Eigen::Vector3d& from, Trajectory& stream) {
  for (int i = 0; i < poses; ++i)
    stream.push_back({begin_us + i * 1'000'000, to_dual_quaternion(Pose{Eigen::Quaterniond::Identity(),
                                                                        from + Eigen::Vector3d(i, 0, 0)})});
}

TEST(DrawnTime, OmitsWhatIsBetweenDrives) {
  Trajectory a;
  drive(5'000'000, 11, {0, 0, 0}, a);
  drive(hour_us, 21, {0, 0, 0}, a);
  drive(2 * hour_us, 2, {0, 0, 0}, a);
  const DrawnTime time(a);
  EXPECT_EQ(time.breaks(), (std::vector<double>{10, 30}));
  EXPECT_EQ(time.seconds(5'000'000), 0);
  EXPECT_EQ(time.seconds(15'000'000), 10);
  EXPECT_EQ(time.seconds(100'000'000), 10) << "within a break";
  EXPECT_EQ(time.seconds(hour_us), 10);
  EXPECT_EQ(time.seconds(hour_us + 4'500'000), 14.5);
  EXPECT_EQ(time.seconds(2 * hour_us + 1'000'000), 31);
  EXPECT_EQ(time.part_of(15'000'000), 0U);
  EXPECT_EQ(time.part_of(16'000'000), 0U) << "another stream goes on for a second";
  EXPECT_EQ(time.part_of(hour_us - 1'000'000), 1U) << "or begins a second earlier";
  EXPECT_EQ(time.part_of(hour_us), 1U);
  EXPECT_EQ(time.part_of(2 * hour_us), 2U);
}

TEST(DrawnTime, ShowsGapsOfSlowStreamsAndShortOnesAsTheyAre) {
  Trajectory slow;
  for (int i = 0; i < 10; ++i) slow.push_back({i * std::int64_t{60'000'000}, {}});
  EXPECT_TRUE(DrawnTime(slow).breaks().empty());
  EXPECT_EQ(DrawnTime(slow).seconds(120'000'000), 120);
  Trajectory gap;
  drive(0, 10, {0, 0, 0}, gap);
  drive(30'000'000, 10, {0, 0, 0}, gap);
  EXPECT_TRUE(DrawnTime(gap).breaks().empty()) << "21 s";
  EXPECT_EQ(DrawnTime({}, 7'000'000).seconds(9'000'000), 2) << "motion pairs alone";
}

/// Each drive of a sensor may have an odometry frame of its own: the paths agree in each, and no line joins
/// them.
TEST(DrawnTime, PathsOfDrivesInFramesOfTheirOwnAgree) {
  Trajectory a, b;
  drive(0, 30, {0, 0, 0}, a);
  drive(0, 30, {0, 0, 0}, b);
  drive(hour_us, 20, {0, 0, 0}, a);
  drive(hour_us, 20, {500, -70, 3}, b);
  const Map map = tools::map_of(a, b, {}, DrawnTime(a));
  ASSERT_EQ(map.a_x.size(), 51U);
  ASSERT_EQ(map.b_x.size(), 51U);
  for (std::size_t i = 0; i < 51; ++i) {
    EXPECT_EQ(std::isnan(map.a_x[i]), i == 30);
    EXPECT_EQ(std::isnan(map.b_x[i]), i == 30);
    if (i == 30) continue;
    EXPECT_NEAR(map.a_x[i], map.b_x[i], 1e-9) << i;
    EXPECT_NEAR(map.a_y[i], map.b_y[i], 1e-9) << i;
  }
  const tools::Excitation turning = tools::excitation_of(a, DrawnTime(a));
  ASSERT_EQ(turning.time.size(), 49U);
  EXPECT_TRUE(std::isnan(turning.time[29]));
  EXPECT_EQ(turning.root_mean_square[2], 0);
  EXPECT_NEAR(turning.path, 48, 1e-9);
}

}  // namespace
}  // namespace egocal::test_drawn_time
