// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The times of text files: in any unit and order, under any name, or none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "../support/tables.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_table_times {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Tables;

/// A time under a name that is not known was passed over without a word, and 10 Hz were assumed.
TEST_F(Tables, AColumnThatIncreasesMayHoldTheTimes) {
  const std::string rows = "1000.0,1,2,3,0,0,0,1\n1000.1,4,5,6,0,0,0,1\n1000.3,4,5,6,0,0,0,1\n";
  const TrajectoryReading reading = read("Zeit,x,y,z,qx,qy,qz,qw\n" + rows);
  ASSERT_EQ(reading.notes.size(), 2u);
  EXPECT_THAT(reading.notes[0], HasSubstr("column 1 (Zeit) increases as times do"));
  EXPECT_THAT(reading.notes[1], HasSubstr("10 Hz assumed"));
  // numbers of rows do as well
  EXPECT_EQ(read("id,x,y,z,qx,qy,qz,qw\n1,1,2,3,0,0,0,1\n2,4,5,6,0,0,0,1\n3,4,5,6,0,0,0,1\n").notes.size(),
            1u);
  EXPECT_THAT(read("t,x,y,z,qx,qy,qz,qw\n" + rows).notes, IsEmpty());
}

/// In a table such a row was skipped, in TUM's format it refused the file.
TEST_F(Tables, ARowWithoutATimeIsSkipped) {
  const TrajectoryReading reading = read("1000.0 1 2 3 0 0 0 1\nnan 4 5 6 0 0 0 1\n1000.1 4 5 6 0 0 0 1\n");
  EXPECT_EQ(reading.trajectory.size(), 2u);
  EXPECT_EQ(reading.losses.refused, 1);
}

TEST_F(Tables, KittiWithoutTimesHasARate) {
  const std::string rows = "1 0 0 1 0 1 0 2 0 0 1 3\n1 0 0 2 0 1 0 2 0 0 1 3\n1 0 0 3 0 1 0 2 0 0 1 3\n";
  const TrajectoryReading assumed = read(rows);
  EXPECT_EQ(assumed.trajectory[2].time_us, 200'000);
  EXPECT_THAT(assumed.notes, ElementsAre(HasSubstr("10 Hz assumed")));
  ReadOptions options;
  options.rate = 20;
  EXPECT_EQ(read(rows, options).trajectory[2].time_us, 100'000);
  options.rate = -1;
  expect_error(rows, "--rate", options);
  // numbers of frames before the matrices, with gaps, as in KITTI-360
  const TrajectoryReading numbered =
      read("3 1 0 0 1 0 1 0 2 0 0 1 3\n4 1 0 0 2 0 1 0 2 0 0 1 3\n9 1 0 0 3 0 1 0 2 0 0 1 3\n");
  EXPECT_EQ(numbered.trajectory[2].time_us - numbered.trajectory[0].time_us, 600'000);
}

TEST_F(Tables, RowsOutOfOrderAreSortedAndCounted) {
  const TrajectoryReading reading =
      read("1 0 0 0 0 0 0 1\n3 3 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n3 9 0 0 0 0 0 1\n");
  ASSERT_EQ(reading.trajectory.size(), 3u);
  EXPECT_EQ(reading.out_of_order, 1u);
  EXPECT_EQ(reading.duplicates, 1u);
  EXPECT_EQ(to_pose(reading.trajectory[2].pose).translation.x(), 3);
  EXPECT_THAT(reading.notes,
              ElementsAre(HasSubstr("1 pose was out of order"), HasSubstr("the first of each")));
}

/// Else the whole file would be in nanoseconds, and hold two times.
TEST_F(Tables, OneWrongTimeDoesNotDecideTheUnit) {
  std::string rows;
  for (int i = 0; i < 50; ++i)
    rows += (i == 20 ? "1600000000000000000" : std::to_string(1600000000 + i)) + " 0 0 0 0 0 0 1\n";
  expect_error(rows, ":21:");
}

/// Neighbouring rows are 23 s and more apart, as milliseconds might be; the times in order are 1 s apart.
TEST_F(Tables, RowsOutOfOrderDoNotChangeTheUnitOfTheirTimes) {
  std::string rows;
  for (int i = 0; i < 60; ++i) rows += std::to_string(1'487'321'563 + i * 37 % 60) + ".5 0 0 0 0 0 0 1\n";
  const TrajectoryReading reading = read(rows);
  ASSERT_EQ(reading.trajectory.size(), 60u);
  EXPECT_EQ(reading.trajectory.front().time_us, 1'487'321'563'500'000);
  EXPECT_EQ(reading.trajectory.back().time_us - reading.trajectory.front().time_us, 59'000'000);
}

TEST_F(Tables, TimesSinceASensorWasSwitchedOnKeepTheirUnit) {
  // what begins so is as long as milliseconds or microseconds since 1970 and is neither
  for (const std::int64_t begin_s : {0, 3, 1'000, 50'000, 1'700'000, 3'000'000})
    for (const std::int64_t second : {1'000ll, 1'000'000ll, 1'000'000'000ll}) {
      const int count = begin_s == 1'700'000 ? 240 : 40;  // fewer rows would be still poses of 2023
      std::string rows;
      for (int i = 0; i < count; ++i)
        rows +=
            std::to_string(begin_s * second + i * second / 20) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
      const Trajectory poses = read(rows).trajectory;
      ASSERT_EQ(poses.size(), static_cast<std::size_t>(count));
      EXPECT_EQ(poses.front().time_us, begin_s * 1'000'000) << second << " a second";
      EXPECT_EQ(poses.back().time_us, begin_s * 1'000'000 + (count - 1) * 50'000) << second << " a second";
    }
}

/// From 10 s between poses on, seconds were taken for milliseconds, and milliseconds for microseconds.
TEST_F(Tables, DatesOfStillPosesKeepTheirUnitHoweverRareTheyAre) {
  for (const std::int64_t second : {1ll, 1'000ll, 1'000'000ll, 1'000'000'000ll})
    for (const std::int64_t step : {5, 10, 15, 60, 3'000}) {
      std::string rows;
      for (std::int64_t i = 0; i < 20; ++i)
        rows +=
            std::to_string((1'700'000'000 + i * step) * second) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
      const Trajectory poses = read(rows).trajectory;
      ASSERT_EQ(poses.size(), 20u);
      EXPECT_EQ(poses.front().time_us, 1'700'000'000'000'000) << second << " a second, " << step << " s";
      EXPECT_EQ(poses.back().time_us - poses.front().time_us, 19'000'000 * step) << second << " a second";
    }
}

/// The message was "out of range" alone.
TEST_F(Tables, AFileOfTimesInAnotherUnitIsRefusedWithTheCure) {
  ReadOptions options;
  const std::string rows = "1 0 0 1 0 1 0 2 0 0 1 3\n1 0 0 2 0 1 0 2 0 0 1 3\n";
  options.times_file = folder_.file("times.txt", "1700000000000\n1700000000100\n");
  expect_error(rows, "times.txt:1: time: expected seconds, or nanoseconds since 1970, got '1700000000000'",
               options);
  expect_error(rows, "milliseconds since 1970: divide the times by 1000", options);
  options.times_file = folder_.file("times.txt", "1700000000000000\n1700000000100000\n");
  expect_error(rows, "divide the times by 1000000", options);
  options.times_file = folder_.file("times.txt", "1700000000000000000\n1700000000100000000\n");
  EXPECT_EQ(read(rows, options).trajectory[1].time_us, 1'700'000'000'100'000);
}

TEST_F(Tables, TimesMayBeDatesOfIso8601) {
  const std::string pose = ",1,2,3,0,0,0.7071068,0.7071068\n", next = ",4,5,6,0,0,0.7071068,0.7071068\n";
  expect_two_poses("t,x,y,z,qx,qy,qz,qw\n2001-09-09T01:46:40Z" + pose + "2001-09-09T01:46:40.1Z" + next);
  expect_two_poses("2001-09-09 01:46:40.000" + pose + "2001-09-09 01:46:40.0999996" + next);
  expect_two_poses("time [UTC],x,y,z,qx,qy,qz,qw\n2001-09-09T03:16:40+01:30" + pose +
                   "2001-09-08T18:46:40.1-0700" + next);
  const TrajectoryReading leap = read("t,x,y,yaw\n2000-02-29T23:59:59Z,0,0,0\n2000-03-01T00:00:00Z,1,0,0\n");
  EXPECT_EQ(leap.trajectory[1].time_us - leap.trajectory[0].time_us, 1'000'000);
  for (const char* wrong :
       {"2001-02-29T00:00:00Z", "2001-13-01T00:00:00Z", "2001-09-09T24:00:00Z", "2001-09-09T01:60:00Z",
        "2001-09-09T01:46:40X", "2001-09-09T01:46:40.", "2001-09-09T01:46:40+99:00", "2001-09-09"})
    expect_error("t,x,y,yaw\n" + std::string(wrong) + ",0,0,0\n", ":2: time: expected a number");
}

TEST_F(Tables, PosesWithoutTimesHaveARate) {
  ReadOptions options;
  options.rate = 20;
  const TrajectoryReading reading = read("1 2 3 0 0 0 1\n4 5 6 0 0 0.7071068 0.7071068\n", options);
  ASSERT_EQ(reading.trajectory.size(), 2u);
  EXPECT_EQ(reading.trajectory[1].time_us, 50'000);
  EXPECT_LT((to_pose(reading.trajectory[1].pose).translation - Eigen::Vector3d(4, 5, 6)).norm(), 1e-12);
  EXPECT_THAT(reading.notes, ::testing::Contains(HasSubstr("x y z qx qy qz qw")));
  // seven numbers without a quaternion are no pose
  expect_error("1 2 3 0.5 0 0 1\n", "expected 8 fields");
}

TEST_F(Tables, WordsWrittenTogetherNameATime) {
  for (const char* name : {"GPSTime", "ImageTimestamp", "rosTime", "header.stamp", "unixtime"})
    expect_two_poses(std::string(name) +
                     ",easting,northing,altitude,roll,pitch,yaw\n"
                     "1000000000.0,1,2,3,0,0,1.5707963\n1000000000.1,4,5,6,0,0,1.5707963\n");
}

}  // namespace
}  // namespace egocal::test_io_table_times
