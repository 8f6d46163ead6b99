// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Velocities, as radars and wheels give them, integrated to poses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>

#include "../support/bag_writer.hpp"
#include "../support/scratch_folder.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/io/twist_integrator.hpp"
#include "egocal/simulation/simulation.hpp"

namespace egocal::test_twist {
namespace {

using ::testing::HasSubstr;
using testing::MessageEncoder;

const Eigen::Vector3d zero = Eigen::Vector3d::Zero();

Pose last_pose(const std::vector<Twist>& twists) {
  TwistIntegrator integrator;
  Pose last;
  for (const Twist& twist : twists) last = to_pose(*integrator.add(twist));
  return last;
}

TEST(Twist, AConstantOneIsACircle) {
  // 2 m/s and 0.1 rad/s: a circle of 20 m; a quarter of it takes pi/2 / 0.1 s
  std::vector<Twist> twists;
  const double duration = std::numbers::pi / 2 / 0.1;
  for (int i = 0; i <= 10; ++i) twists.push_back({std::llround(1e5 * duration * i), {2, 0, 0}, {0, 0, 0.1}});
  const Pose end = last_pose(twists);
  EXPECT_LT((end.translation - Eigen::Vector3d(20, 20, 0)).norm(), 1e-4);
  EXPECT_NEAR(2 * std::atan2(end.rotation.z(), end.rotation.w()), std::numbers::pi / 2, 1e-6);
}

// 1 - cos x of a turn of 1.1e-6 rad keeps four of its sixteen digits: the way aside was off by 7e-5 of
// itself.
TEST(Twist, ATurnThatIsHardlyOneHasItsWayAside) {
  for (const double turn : {1e-7, 1.1e-6, 3e-5, 2e-3, 0.0099, 0.0101}) {
    const Pose end = last_pose({{0, {1, 0, 0}, {0, 0, turn}}, {1'000'000, {1, 0, 0}, {0, 0, turn}}});
    const double aside = 2 * std::sin(0.5 * turn) * std::sin(0.5 * turn) / turn;
    EXPECT_NEAR(end.translation.y(), aside, 1e-15 + 1e-9 * aside) << turn;
    EXPECT_NEAR(end.translation.x(), std::sin(turn) / turn, 1e-15) << turn;
  }
}

TEST(Twist, StraightAheadAndTurningOnTheSpot) {
  const Pose straight = last_pose({{0, {1, 0, 0}, zero}, {2'000'000, {3, 0, 0}, zero}});
  EXPECT_LT((straight.translation - Eigen::Vector3d(4, 0, 0)).norm(), 1e-12) << "the mean of both velocities";
  const Pose turned = last_pose({{0, zero, {0.3, 0, 0}}, {1'000'000, zero, {0.3, 0, 0}}});
  EXPECT_LT(turned.translation.norm(), 1e-15);
  EXPECT_NEAR(2 * std::asin(turned.rotation.x()), 0.3, 1e-12);
}

TEST(Twist, WhatIsNotLaterOrNotFiniteIsRefusedAndLosesNothing) {
  TwistIntegrator integrator;
  ASSERT_TRUE(integrator.add({1'000'000, {1, 0, 0}, zero}));
  EXPECT_FALSE(integrator.add({1'000'000, {1, 0, 0}, zero}));
  EXPECT_FALSE(integrator.add({500'000, {1, 0, 0}, zero}));
  EXPECT_FALSE(integrator.add({1'500'000, {std::nan(""), 0, 0}, zero}));
  EXPECT_FALSE(integrator.add({1'600'000, {1e300, 0, 0}, {0, 1e300, 0}}));
  EXPECT_FALSE(integrator.add({1'600'000, {1e12, 0, 0}, zero}));
  EXPECT_NEAR(to_pose(*integrator.add({2'000'000, {1, 0, 0}, zero})).translation.x(), 1, 1e-12);
}

/// What an ideal radar would measure on the way: the twist of the motion to the next pose.
std::vector<Twist> twists_of(const Trajectory& path) {
  std::vector<Twist> twists;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double seconds = 1e-6 * static_cast<double>(path[i + 1].time_us - path[i].time_us);
    const Pose step = to_pose(conjugate(path[i].pose) * path[i + 1].pose);
    const Eigen::Vector3d axis(step.rotation.x(), step.rotation.y(), step.rotation.z());
    const double angle = 2 * std::atan2(axis.norm(), step.rotation.w());
    const Eigen::Vector3d turn =
        axis.norm() > 0 ? Eigen::Vector3d(axis.normalized() * angle) : Eigen::Vector3d::Zero();
    // small steps: the way is the velocity turned by half of the turn
    const Eigen::Quaterniond half = rotation_exp(-0.5 * turn);
    twists.push_back({path[i].time_us, half * Eigen::Vector3d(step.translation) / seconds, turn / seconds});
  }
  return twists;
}

class RadarDrive : public ::testing::Test {
 protected:
  RadarDrive() {
    SimulationOptions options;
    options.poses = 1500;
    options.rate = 50;
    options.terrain = Terrain::free;
    options.T_vehicle_sensor = {Pose{}, T};
    drive = simulate(options);
    write_tum(folder.path("lidar.tum"), drive[0]);
  }
  void expect_extrinsic(const std::string& radar) const {
    const TrajectoryReading reading = read_trajectory_file(radar);
    EXPECT_THAT(reading.notes, ::testing::Contains(HasSubstr("integrated"))) << radar;
    const Calibration calibration = calibrate(read_trajectory(folder.path("lidar.tum")), reading.trajectory);
    EXPECT_LT((calibration.T_a_b.translation - T.translation).norm(), 0.05) << radar;
    EXPECT_LT(Eigen::Quaterniond(calibration.T_a_b.rotation).angularDistance(Eigen::Quaterniond(T.rotation)),
              0.01)
        << radar;
  }

  const Pose T{rotation_exp({0.3, -0.2, 1.0}), {0.5, -0.2, 0.3}};
  std::vector<Trajectory> drive;
  testing::ScratchFolder folder;
};

TEST_F(RadarDrive, ACsvOfVelocitiesGivesTheExtrinsic) {
  std::ofstream csv(folder.path("radar.csv"));
  csv << "time,vx,vy,vz,wx,wy,wz\n";
  csv.precision(17);
  for (const Twist& t : twists_of(drive[1]))
    csv << 1e-6 * static_cast<double>(t.time_us) << ',' << t.linear.x() << ',' << t.linear.y() << ','
        << t.linear.z() << ',' << t.angular.x() << ',' << t.angular.y() << ',' << t.angular.z() << '\n';
  csv.close();
  expect_extrinsic(folder.path("radar.csv"));
}

TEST_F(RadarDrive, TwistStampedOfABagGivesTheExtrinsic) {
  for (const MessageEncoder::Kind kind : {MessageEncoder::Kind::ros1, MessageEncoder::Kind::cdr}) {
    std::vector<testing::WrittenMessage> messages;
    for (const Twist& t : twists_of(drive[1])) {
      MessageEncoder to(kind);
      to.header(t.time_us, "radar");
      for (const Eigen::Vector3d& v : {t.linear, t.angular})
        for (int i = 0; i < 3; ++i) to.f64(v[i]);
      messages.push_back({"/radar", "geometry_msgs/TwistStamped", t.time_us, to.done()});
    }
    const bool cdr = kind == MessageEncoder::Kind::cdr;
    const std::string name = cdr ? "radar.mcap" : "radar.bag";
    folder.file(name,
                cdr ? testing::mcap_file(messages, {"zstd"}) : testing::rosbag1_file(messages, {"lz4"}));
    expect_extrinsic(folder.path(name) + ":/radar");
  }
}

TEST_F(RadarDrive, SpeedAndYawRateAreEnough) {
  std::ofstream csv(folder.path("car.csv"));
  csv << "timestamp,speed,yaw_rate [deg/s]\n";
  for (int i = 0; i <= 100; ++i) csv << 100 + 0.1 * i << ",2,9\n";
  csv.close();
  const Trajectory path = read_trajectory(folder.path("car.csv"));
  ASSERT_EQ(path.size(), 101u);
  // 10 s at 9 deg/s: a quarter of a circle of 2 / 0.157 m
  const double radius = 2 / (std::numbers::pi / 20);
  EXPECT_LT((to_pose(path.back().pose).translation - Eigen::Vector3d(radius, radius, 0)).norm(), 1e-6);
}

TEST_F(RadarDrive, PosesAreTakenWhereBothAreThere) {
  std::ofstream csv(folder.path("both.csv"));
  csv << "t,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n1,7,0,0,0,0,0,1,,,,,,\n2,8,0,0,0,0,0,1,5,0,0,0,0,0\n";
  csv.close();
  const Trajectory path = read_trajectory(folder.path("both.csv"));
  ASSERT_EQ(path.size(), 2u) << "an empty velocity spoils no pose";
  EXPECT_EQ(to_pose(path[1].pose).translation.x(), 8);
  std::ofstream(folder.path("none.csv")) << "vx,wz\n1,0\n1,0\n";
  EXPECT_THROW(read_trajectory(folder.path("none.csv")), Error) << "velocities without times";
}

}  // namespace
}  // namespace egocal::test_twist
