// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Text files as people have them: whatever the header, separator, unit and order, the same poses come out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "../support/tables.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_tables {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Tables;

TEST_F(Tables, HeadersInManyStylesMeanTheSame) {
  const std::string rows =
      "1000000000.0,1,2,3,0,0,0.7071068,0.7071068\n1000000000.1,4,5,6,0,0,0.7071068,0.7071068\n";
  for (const char* header :
       {"t,x,y,z,qx,qy,qz,qw", "timestamp,tx,ty,tz,q_x,q_y,q_z,q_w",
        "Time [s], X [m], Y [m], Z [m], Qx, Qy, Qz, Qw",
        "time,position.x,position.y,position.z,orientation.x,orientation.y,orientation.z,orientation.w",
        "%time,field.pose.pose.position.x,field.pose.pose.position.y,field.pose.pose.position.z,"
        "field.pose.pose.orientation.x,field.pose.pose.orientation.y,field.pose.pose.orientation.z,"
        "field.pose.pose.orientation.w",
        "# time,p_x,p_y,p_z,quat_x,quat_y,quat_z,quat_w",
        "\xef\xbb\xbftime,pos_x,pos_y,pos_z,quaternion_x,quaternion_y,quaternion_z,quaternion_w"})
    expect_two_poses(std::string(header) + "\n" + rows);
  expect_two_poses(rows);  // without a header: seconds, w last, as hand-eye tools write it
}

/// With its own header EuRoC's csv was a "table" whose nanoseconds were remarked upon.
TEST_F(Tables, EurocIsEurocWithItsHeader) {
  const std::string rows =
      "1000000000000000000,1,2,3,0.7071068,0,0,0.7071068,9\n1000000000100000000,4,5,6,0.7071068,0,0,0."
      "7071068,9"
      "\n";
  for (const std::string header : {"",
                                   "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x "
                                   "[], q_RS_y [], q_RS_z [], v\n",
                                   "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], "
                                   "q_RS_x [], q_RS_y [], q_RS_z [], "
                                   "v\n"}) {
    expect_two_poses(header + rows);
    EXPECT_EQ(read(header + rows).format, "EuRoC csv") << header;
    EXPECT_THAT(read(header + rows).notes, IsEmpty()) << header;
  }
  EXPECT_EQ(read("#t,x,y,z,qw,qx,qy,qz\n1,1,2,3,1,0,0,0\n2,1,2,3,1,0,0,0\n").format, "table");
}

TEST_F(Tables, OtherOrdersSeparatorsAndUnits) {
  expect_two_poses(
      "qw;qx;qy;qz;x[mm];y[mm];z[mm];t[ns]\n"
      "0.7071068;0;0;0.7071068;1000;2000;3000;1000000000000000000\n"
      "0.7071068;0;0;0.7071068;4000;5000;6000;1000000000100000000\n");
  expect_two_poses("t;x;y;z;yaw\n1000000000;1,0;2,0;3,0;1,5707963\n1000000000,1;4,0;5,0;6,0;1,5707963\n");
  expect_two_poses(
      "secs,nsecs,x,y,z,roll_deg,pitch_deg,yaw_deg,vx\n1000000000,0,1,2,3,0,0,90,7\n"
      "1000000000,100000000,4,5,6,0,0,90,7\n");
  expect_two_poses(
      "time\tx\ty\tz\troll\tpitch\tyaw\n1000000000\t1\t2\t3\t0\t0\t90\n1000000000.1\t4\t5\t6\t0\t0\t90\n");
  expect_two_poses(
      "time,velocity_x,x,y,z,angular.x,theta,covariance_x\n1000000000,9,1,2,3,9,1.5707963,9\n"
      "1000000000.1,9,4,5,6,9,1.5707963,9\n");
  for (const char* time : {"1000000000000 1000000000100", "1000000000000000 1000000000100000",
                           "1000000000000000000 1000000000100000000",
                           "1000000000000000000.000000 1000000000100000000.000000"}) {  // ORB-SLAM3
    const std::string both = time;
    const std::string first = both.substr(0, both.find(' ')), second = both.substr(both.find(' ') + 1);
    expect_two_poses(first + " 1 2 3 0 0 0.7071068 0.7071068\n" + second +
                     " 4 5 6 0 0 0.7071068 0.7071068\n");
  }
}

TEST_F(Tables, ColumnsCanBeNamedByHand) {
  ReadOptions options;
  options.columns = "-,x,y,z,yaw[deg],t";
  expect_two_poses("7 1 2 3 90 1000000000\n8 4 5 6 90 1000000000.1\n", options);
  expect_two_poses("a b c d e f\n7 1 2 3 90 1000000000\n8 4 5 6 90 1000000000.1\n", options);
  options.columns = "t,x,y";
  expect_error("1 2 3\n", "no orientation", options);
  options.columns = "t,x,y,z,yaw";
  expect_error("1 2 3\n", ":1: expected at least 5 fields", options);
}

TEST_F(Tables, YawAloneIsAPoseInThePlane) {
  const TrajectoryReading reading = read("t,x,y,yaw\n0,1,2,0\n0.1,3,4,0.5\n");
  const Pose pose = to_pose(reading.trajectory[1].pose);
  EXPECT_LT((rotation_log(pose.rotation) - Eigen::Vector3d(0, 0, 0.5)).norm(), 1e-12);
  EXPECT_EQ(pose.translation.z(), 0);
  EXPECT_THAT(reading.notes, ElementsAre(HasSubstr("radians")));
}

/// A degree of latitude is 110.6 km at the equator (WGS 84), one of longitude 111.3 km; east is x, north is
/// y.
TEST_F(Tables, GeodeticPositionsBecomeLocalMetres) {
  const TrajectoryReading reading = read(
      "time,latitude,longitude,altitude,roll,pitch,heading\n0,0,9,100,0,0,90\n1,0.001,9,100,0,0,90\n"
      "2,0,9.001,100,0,0,180\n3,0,9,110,0,0,90\n");
  const auto at = [&](std::size_t i) { return to_pose(reading.trajectory[i].pose); };
  EXPECT_LT(at(0).translation.norm(), 1e-9);
  EXPECT_NEAR(at(1).translation.y(), 110.575, 0.01);
  EXPECT_NEAR(at(1).translation.x(), 0, 1e-6);
  EXPECT_NEAR(at(2).translation.x(), 111.321, 0.01);
  EXPECT_NEAR(at(3).translation.z(), 10, 1e-6);
  EXPECT_LT(rotation_log(at(0).rotation).norm(), 1e-9);  // heading east is along x
  EXPECT_NEAR(rotation_log(at(2).rotation).z(), -std::numbers::pi / 2, 1e-4);
}

TEST_F(Tables, StrictRefusesWhatWouldBeRepaired) {
  ReadOptions strict;
  strict.strict = true;
  EXPECT_EQ(read("1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n", strict).trajectory.size(), 2u);
  expect_error("1 0 0 0 0 0 0 1\n3 2 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n",
               "pose 3, at 2.000000 s, comes after a later one", strict);
  expect_error("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n",
               "pose 2, at 1.000000 s, has the time of the one before it", strict);
}

TEST_F(Tables, DecimalCommasAreReadWhereNothingElseIsMeant) {
  const std::string commas =
      "1000000000 1,0 2,0 3,0 0 0 0,7071068 0,7071068\n"
      "1000000000,1 4,0 5,0 6,0 0 0 0,7071068 0,7071068\n";
  std::string tabs = commas, semicolons = commas;
  std::replace(tabs.begin(), tabs.end(), ' ', '\t');
  std::replace(semicolons.begin(), semicolons.end(), ' ', ';');
  for (const std::string& rows : {commas, tabs, semicolons}) expect_two_poses(rows);
  expect_two_poses("t x y z qx qy qz qw\n" + commas);
  // every field of the first row has one, and it is no header
  expect_two_poses(
      "1000000000,0;1,0;2,0;3,0;0,0;0,0;0,7071068;0,7071068\n"
      "1000000000,1;4,0;5,0;6,0;0,0;0,0;0,7071068;0,7071068\n");
  // a last row of whole numbers
  EXPECT_EQ(read("t;x;y;z;yaw\n1,5;1;2;3;0\n2;1;2;3;0\n").trajectory.front().time_us, 1'500'000);
}

TEST_F(Tables, ADecimalCommaAmongPointsIsNamed) {
  const std::string cure = "; write decimals with a point";
  expect_error("1.5 2,3 1.0 0 0 0 0 1\n1.6 2.4 1,0 0 0 0 0 1\n", "(tx): expected a number, got '2,3'" + cure);
  expect_error("1.5 2.3 1.0 0 0 0 0 1\n1.6 2.4 1,0 0 0 0 0 1\n",
               ":2: field 3 (ty): expected a number, got '1,0'" + cure);
  expect_error("t;x;y;yaw\n1.5;2.5;3.5;0\n1,6;2;3;0\n", "'1,6'" + cure);
  expect_error("t,x,y,z,yaw\n\"1,5\",\"2,5\",0,0,0\n", cure);
}

TEST_F(Tables, AFileWithoutAnyPoseIsNotAskedForByAName) {
  const std::string refused = "2 without a usable pose skipped (first: line 2: an empty field)";
  try {
    read("t,x,y,yaw\n0,,,\n1,,,\n");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              folder_.path("table") + ": holds no pose that can be read; " + refused);
  }
}

TEST_F(Tables, RowsLongerThanTheirHeaderAreNotGuessedAt) {
  // decimal commas between commas, or a first column that has no name
  expect_error(
      "t,x,y,z,qx,qy,qz,qw\n1,5,2,3,1,0,0,0,0,0,1\n",
      ":2: expected 8 fields, as the header has names, got 11; write decimals with a point, or name the "
      "columns with --columns");
  expect_error("t x y yaw\n0 1.5 2 3 0\n", ":2: expected 4 fields, as the header has names, got 5");
  EXPECT_EQ(read("t,x,y,yaw\n0,1,2,0,\n", {}).trajectory.size(), 1u);  // a comma behind the last field
  ReadOptions named;
  named.columns = "-,t,x,y,yaw";
  EXPECT_EQ(read("t,x,y,yaw\n0,1,2,3,0\n", named).trajectory.size(), 1u);
}

TEST_F(Tables, ALastRowThatIsCutOffIsCounted) {
  const TrajectoryReading reading = read("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n3 0 0 0 0");
  EXPECT_EQ(reading.trajectory.size(), 2u);
  EXPECT_TRUE(reading.losses.truncated);
  expect_error("1 0 0 0 0 0 0 1\n2 0 0 0 0\n3 0 0 0 0 0 0 1\n", ":2: expected 8 fields");
  // in the midst of its last number
  for (const char* cut : {"3 0 0 0 0.6 0 0 0.", "3 0 0 0 0.6 0 0 -", "3 0 0 0 0.6 0 0 0.7"}) {
    const TrajectoryReading of_number = read(std::string("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n") + cut);
    EXPECT_EQ(of_number.trajectory.size(), 2u) << cut;
    EXPECT_TRUE(of_number.losses.truncated) << cut;
    expect_error(std::string("1 0 0 0 0 0 0 1\n") + cut + "\n", ":2");
  }
  expect_error("1 0 0 0 0 0 0 1\n2 0 0 x 0 0 0 1", ":2");
  expect_error("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1 5", ":2: expected 8 fields");
}

TEST_F(Tables, EmptyFieldsOfATableAreCounted) {
  const TrajectoryReading reading = read("t,x,y,yaw,note\n0,1,2,0,a\n1,,,,b\n1.5,,,,\n2,3,4,0.5,c\n");
  EXPECT_EQ(reading.trajectory.size(), 2u);
  EXPECT_EQ(reading.losses.refused, 2u);
  EXPECT_THAT(reading.losses.first_refused, HasSubstr("line 3"));
}

TEST_F(Tables, AHeadingIsOneOfACompass) {
  const TrajectoryReading reading = read("t,x,y,heading[deg]\n0,0,0,90\n1,1,0,90\n");
  EXPECT_LT(rotation_log(to_pose(reading.trajectory[0].pose).rotation).norm(), 1e-12);
  EXPECT_THAT(reading.notes, ::testing::Contains(HasSubstr("clockwise from north")));
  EXPECT_THAT(read("t,lat,lon,heading[deg]\n0,48,9,90\n1,48.1,9,90\n").notes,
              ::testing::Contains(HasSubstr("clockwise from north")));
}

TEST_F(Tables, OtherKindsOfTextAreNamed) {
  expect_error("[{\"t\": 1, \"x\": 2}]\n", "is JSON");
  expect_error("\n<?xml version=\"1.0\"?>\n<gpx/>\n", "is XML");
  expect_error("ply\nformat ascii 1.0\n", "is a point cloud");
  expect_error("VERTEX_SE3:QUAT 0 1 2 3 0 0 0 1\n", "is a pose graph");
}

TEST_F(Tables, WhatIsNotUnderstoodIsSaid) {
  expect_error("time,a,b,c\n1,2,3,4\n", "no position");
  expect_error("time,x,y,z\n1,2,3,4\n", "no orientation");
  expect_error("time,x,y,z\n1,2,3,4\n", "--columns");
  expect_error(std::string("\0\1\2\3", 4), "neither text nor a known recording");
  expect_error("#ROSBAG V1.2\nabc", "rosbag fix");
  EXPECT_THROW(read_trajectory(folder_.file("a.tum", "1 0 0 0 0 0 0 1\n") + ":/topic"), Error);
  EXPECT_THROW(read_trajectory(folder_.path("")), Error);
  EXPECT_THAT(read("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n").notes, IsEmpty());
}

TEST_F(Tables, AWordWhereANumberIsExpectedNamesTheCure) {
  expect_error("1000000000,5,odom,base,1,2,3,0,0,0\n1000000000,105,odom,base,1,2,3,0,0,0\n", "--columns");
}

TEST_F(Tables, WhatRos2EchoesAsCsv) {
  for (const char* frames : {"odom", "odom,base", ",", ""})
    for (const char* more : {"", ",0.1,0.1,0.0"})
      expect_two_poses("1000000000,0," + std::string(frames) + ",1,2,3,0,0,0.70710678,0.70710678" + more +
                       "\n1000000000,100000000," + frames + ",4,5,6,0,0,0.70710678,0.70710678" + more + "\n");
  // no quaternion
  expect_error("1000000000,0,odom,1,2,3,0,0,0.5,0.5\n", "expected a number, got 'odom'");
}

TEST_F(Tables, PackedWhole) {
  // the rows of two poses by bzip2 and lz4
  expect_two_poses(std::string(
      "\102\132\150\071\061\101\131\046\123\131\126\136\246\352\000\000\031\330\000\002\020\100\001\177"
      "\300\040\000\110\052\222\172\043\031\100\252\203\040\014\255\134\224\261\033\346\073\133\151\035"
      "\053\007\207\250\262\163\151\046\032\040\251\342\017\213\271\042\234\050\110\053\057\123\165\000",
      72));
  expect_two_poses(std::string(
      "\004\042\115\030\144\100\247\070\000\000\000\044\061\060\001\000\240\056\060\040\061\040\062\040"
      "\063\040\060\002\000\227\056\067\060\067\061\060\066\067\070\013\000\027\012\055\000\160\061\040"
      "\064\040\065\040\066\053\000\007\042\000\003\013\000\120\060\066\067\070\012\000\000\000\000\365"
      "\337\102\060",
      75));
}

TEST_F(Tables, FieldsInQuotes) {
  expect_two_poses(
      "\"t\",\"x\",\"y\",\"z\",\"roll\",\"pitch\",\"yaw\"\n"
      "\"1000000000.0\", \"1\" ,\"2\",\"3\",\"0\",\"0\",\"1.5707963\"\n"
      "\"1000000000.1\",\"4\",\"5\",\"6\",\"0\",\"0\",\"1.5707963\"\n");
  expect_error("t,x,y,yaw\n\"1,2,3,4\n", ":2: time: expected a number, got '\"1'");
}

TEST_F(Tables, OtherBinaryFilesAreNamedWithTheCure) {
  const auto starting = [](std::string begin) { return begin.append("\0\1\0", 3); };
  expect_error(starting("PK\x03\x04"), "is a zip archive: unpack it");
  expect_error(starting("\x93NUMPY"), "numpy.savetxt");
  expect_error(starting("ULog"), "ulog2csv");
  expect_error(starting("\xff\xfe"), "UTF-16");
}

TEST_F(Tables, ElementsOfArraysAreColumns) {
  expect_two_poses(
      "timestamp,position[0],position[1],position[2],q[0],q[1],q[2],q[3],velocity[0],position_offset[0]\n"
      "1000000000000000,1,2,3,0.70710678,0,0,0.70710678,9,9\n"
      "1000000000100000,4,5,6,0.70710678,0,0,0.70710678,9,9\n");
}

TEST_F(Tables, VelocitiesWrittenTogetherAreNoPositions) {
  expect_two_poses(
      "GPSTime,easting,northing,altitude,vel_east,roll,pitch,yaw,angvel_z,linacc_x\n"
      "1000000000.0,1,2,3,9,0,0,1.5707963,9,9\n1000000000.1,4,5,6,9,0,0,1.5707963,9,9\n");
}

/// COLMAP holds T_camera_world: for the poses that expect_two_poses() wants, q is -90 degrees about z and t =
/// -R' p.
const std::string colmap =
    "# Image list with two lines of data per image:\n"
    "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
    "#   POINTS2D[] as (X, Y, POINT3D_ID)\n"
    "# Number of images: 2, mean observations per image: 1\n";

TEST_F(Tables, ImagesOfColmapAreInvertedAndOrderedByTheirNames) {
  const std::string second = "1 0.70710678 0 0 -0.70710678 -5 4 -6 1 cam0/1000000000100000000.png\n";
  const std::string first = "2 0.70710678 0 0 -0.70710678 -2 1 -3 1 cam0/1000000000000000000.png\n";
  expect_two_poses(colmap + second + "10.5 20 -1 3 4 17\n" + first + "\n");  // a line of points may be empty
  expect_two_poses(colmap + second + "\n" + first);

  ReadOptions options;
  options.rate = 20;
  const TrajectoryReading frames =
      read(colmap + "1 1 0 0 0 1 2 3 1 left_000012.jpg\n\n2 1 0 0 0 1 2 4 1 left_000011.jpg\n\n", options);
  ASSERT_EQ(frames.trajectory.size(), 2u);
  EXPECT_EQ(frames.trajectory[0].time_us, 550'000);
  EXPECT_EQ(to_pose(frames.trajectory[0].pose).translation, Eigen::Vector3d(-1, -2, -4));
  EXPECT_THAT(frames.notes, ::testing::Contains(HasSubstr("--scale-a auto where this is A")));
}

TEST_F(Tables, DamagedImagesOfColmap) {
  const std::string image = "1 1 0 0 0 1 2 3 1 000012.jpg\n\n";
  expect_error(colmap, "holds no data");
  expect_error(colmap + "1 1 0 0 0 1 2 3 1 left.jpg\n\n", "number of a frame");
  expect_error(colmap + image + "2 1 0 0 x 1 2 3 1 000013.jpg\n\n", ":7: QZ");
  expect_error(colmap + image + "2 1 0 0\n\n", "expected 10 fields");
  EXPECT_EQ(read(colmap + image + "2 1 0 0").trajectory.size(), 1u);  // cut off
  EXPECT_FALSE(read(colmap + image).has_scale);
}

}  // namespace
}  // namespace egocal::test_io_tables
