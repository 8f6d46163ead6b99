// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Which of several columns counts: the header's time, the position that goes with the orientation, and the
// angles of a compass.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "../support/scratch_folder.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_columns {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Columns : public ::testing::Test {
 protected:
  TrajectoryReading read(const std::string& content) const {
    return read_trajectory_file(folder_.file("table", content));
  }
  testing::ScratchFolder folder_;
};

/// phi, theta and psi are roll, pitch and yaw; theta alone is the heading of a robot in the plane.
TEST_F(Columns, GreekLettersOfAnglesAreRollPitchAndYaw) {
  for (const char* const header : {"t,x,y,z,phi,theta,psi", "t,x,y,z,phi[rad],theta[rad],psi[rad]"}) {
    const Trajectory poses =
        read(std::string(header) + "\n0,1,2,3,0.1,0.2,0.3\n1,1,2,3,0.1,0.2,0.3\n").trajectory;
    ASSERT_EQ(poses.size(), 2u);
    const Rotation expected = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                              Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX());
    EXPECT_LT(to_pose(poses[0].pose).rotation.angularDistance(expected), 1e-12) << header;
  }
  const Trajectory psi_first = read("t,x,y,z,psi,theta,phi\n0,1,2,3,0.3,0,0\n1,1,2,3,0.3,0,0\n").trajectory;
  EXPECT_NEAR(rotation_log(to_pose(psi_first[0].pose).rotation).z(), 0.3, 1e-12);
  // heading and steering
  const Trajectory bicycle = read("t,x,y,theta,phi\n0,1,2,0.3,9\n1,1,2,0.3,9\n").trajectory;
  EXPECT_NEAR(rotation_log(to_pose(bicycle[0].pose).rotation).z(), 0.3, 1e-12);
  const Trajectory plane = read("t,x,y,theta,phi_rate\n0,1,2,0.3,9\n1,1,2,0.3,9\n").trajectory;
  EXPECT_NEAR(rotation_log(to_pose(plane[0].pose).rotation).z(), 0.3, 1e-12);
}

/// Bags as csv: the time of recording is 0.25 s later than the header's.
TEST_F(Columns, TheTimeOfTheHeaderCounts) {
  const std::string pose = "x,y,z,qx,qy,qz,qw\n", row = "1,2,3,0,0,0,1\n";
  struct Export {
    std::string header, times, used, other;
  };
  for (const Export& one : {
           Export{"Time,header.seq,header.stamp.secs,header.stamp.nsecs,header.frame_id,",
                  "1000000000.25,1,1000000000,5000,odom,", "header.stamp.secs and header.stamp.nsecs",
                  "Time"},
           Export{"rosbagTimestamp,header,seq,stamp,secs,nsecs,", "1000000000250000000,,1,,1000000000,5000,",
                  "secs and nsecs", "rosbagTimestamp"},
           Export{"timestamp,header.stamp.sec,header.stamp.nanosec,", "1000000000250000000,1000000000,5000,",
                  "header.stamp.sec and header.stamp.nanosec", "timestamp"},
           Export{"__time,/odom/header/stamp/sec,/odom/header/stamp/nanosec,",
                  "1000000000.25,1000000000,5000,", "/odom/header/stamp/sec and /odom/header/stamp/nanosec",
                  "__time"},
           Export{"__time,/odom/header/stamp,", "1000000000.25,1000000000.000005,", "/odom/header/stamp",
                  "__time"},
           Export{"%time,field.header.stamp,", "1000000000250000000,1000000000000005000,",
                  "field.header.stamp", "time"},
       }) {
    const TrajectoryReading reading = read(one.header + pose + one.times + row + one.times + row);
    EXPECT_EQ(reading.trajectory[0].time_us, 1'000'000'000'000'005) << one.header;
    EXPECT_THAT(reading.notes,
                Contains(HasSubstr("the times are those of " + one.used + ", not " + one.other)))
        << one.header;
  }
  for (const std::string header : {"recv_time,stamp,", "exposure_time,t,", "log_time,time,"}) {
    const TrajectoryReading reading = read(header + pose + "7,1000000000," + row + "8,1000000001," + row);
    EXPECT_EQ(reading.trajectory[0].time_us, 1'000'000'000'000'000) << header;
  }
}

TEST_F(Columns, PositionAndOrientationAreOfOneThing) {
  const std::string rows = "0,9,9,9,1,2,3,0,0,0,1\n1,9,9,9,4,5,6,0,0,0,1\n";
  for (const std::string header :
       {"t,target.x,target.y,target.z,pose.x,pose.y,pose.z,pose.qx,pose.qy,pose.qz,pose.qw\n",
        "t,goal/position/x,goal/position/y,goal/position/z,odom/p/x,odom/p/y,odom/p/z,odom/q/x,odom/q/y,odom/"
        "q/z,odom/q/w\n"}) {
    const TrajectoryReading reading = read(header + rows);
    EXPECT_LT((to_pose(reading.trajectory[0].pose).translation - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
    EXPECT_THAT(reading.notes, IsEmpty()) << header;
  }
  // the orientation of the thing that has a position
  const TrajectoryReading reading = read(
      "t,imu.qx,imu.qy,imu.qz,imu.qw,car.x,car.y,car.z,car.qx,car.qy,car.qz,car.qw\n"
      "0,1,0,0,0,1,2,3,0,0,0,1\n1,1,0,0,0,1,2,3,0,0,0,1\n");
  EXPECT_LT(rotation_log(to_pose(reading.trajectory[0].pose).rotation).norm(), 1e-12);
  // two things, and names that tell nothing
  EXPECT_THAT(read("t,car.x,car.y,car.qx,car.qy,car.qz,car.qw,van.x,van.y,van.qx,van.qy,van.qz,van.qw\n"
                   "0,1,2,0,0,0,1,3,4,0,0,0,1\n1,1,2,0,0,0,1,3,4,0,0,0,1\n")
                  .notes,
              Contains(HasSubstr("car.x (not van.x)")));
  EXPECT_THAT(read("t,body_x,body_y,body_z,world_x,world_y,world_z,qx,qy,qz,qw\n" + rows).notes,
              Contains(HasSubstr("body_x (not world_x)")));
}

/// East, 45 degrees up, the right wing 30 degrees down.
TEST_F(Columns, RollAndPitchBesideAHeadingAreThoseOfAVehicle) {
  const Eigen::Vector3d nose(std::sqrt(0.5), 0, std::sqrt(0.5));
  for (const std::string header : {"t,latitude,longitude,altitude,roll[deg],pitch[deg],heading[deg]\n",
                                   "t,easting,northing,altitude,roll[deg],pitch[deg],azimuth[deg]\n"}) {
    const TrajectoryReading reading = read(header + "0,48,9,500,30,45,90\n1,48,9,500,30,45,90\n");
    const Eigen::Quaterniond R = to_pose(reading.trajectory[0].pose).rotation;
    EXPECT_LT((R * Eigen::Vector3d(1, 0, 0) - nose).norm(), 1e-9) << header;
    EXPECT_LT((R * Eigen::Vector3d(0, 1, 0)).z() - std::sqrt(0.5) * 0.5, 1e-9) << header;  // the left one up
    EXPECT_GT((R * Eigen::Vector3d(0, 1, 0)).z(), 0.3) << header;
    EXPECT_THAT(reading.notes,
                Contains(HasSubstr("pitch with the nose up and roll with the right side down")));
  }
  // beside a yaw they are those of R = Rz Ry Rx
  const TrajectoryReading reading =
      read("t,x,y,z,roll[deg],pitch[deg],yaw[deg]\n0,1,2,3,0,45,0\n1,1,2,3,0,45,0\n");
  EXPECT_LT((to_pose(reading.trajectory[0].pose).rotation * Eigen::Vector3d(1, 0, 0)).z(), -0.7);
  EXPECT_THAT(reading.notes, Not(Contains(HasSubstr("nose up"))));
}

}  // namespace
}  // namespace egocal::test_io_columns
