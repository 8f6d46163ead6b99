// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Tables whose names take several lines, and lines before the rows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "../support/tables.hpp"

namespace egocal::test_io_titles {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::Tables;

/// As a motion capture system writes two rigid bodies; position: of the unit of lengths.
std::string capture(const std::string& unit, const std::string& first, const std::string& second) {
  return "Format Version,1.23,Take Name,a take,Capture Frame Rate,10.0,Length Units," + unit +
         ",Coordinate Space,Global\n"
         "\n"
         ",,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid "
         "Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body\n"
         ",,rig,rig,rig,rig,rig,rig,rig,rig,car,car,car,car,car,car\n"
         ",,\"A1\",\"A1\",\"A1\",\"A1\",\"A1\",\"A1\",\"A1\",\"A1\",\"B2\",\"B2\",\"B2\",\"B2\",\"B2\","
         "\"B2\"\n"
         ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker "
         "Error,Rotation,Rotation,Rotation,Rotation,Position,Position\n"
         "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z,W,X,Y\n"
         "0,1000000000.0,0,0,0.7071068,0.7071068," +
         first +
         ",0.0003,0,0,0,1,9,9\n"
         "1,1000000000.1,0,0,0.7071068,0.7071068," +
         second + ",0.0003,0,0,0,1,9,9\n";
}

TEST_F(Tables, NamesOfSeveralLinesAreRead) {
  expect_two_poses(capture("Meters", "1,2,3", "4,5,6"));
  expect_two_poses(capture("Centimeters", "100,200,300", "400,500,600"));
  expect_two_poses(capture("Millimeters", "1000,2000,3000", "4000,5000,6000"));
  EXPECT_THAT(read(capture("Meters", "1,2,3", "4,5,6")).notes,
              Contains("the names of the columns are those of lines 1 to 7"));
}

/// Where a body was lost its fields are empty.
TEST_F(Tables, APoseThatWasLostIsSkipped) {
  const TrajectoryReading reading =
      read(capture("Meters", "1,2,3", "4,5,6") + "2,1000000000.2,,,,,,,,,0,0,0,1,9,9\n");
  EXPECT_EQ(reading.trajectory.size(), 2u);
  EXPECT_EQ(reading.losses.refused, 1u);
}

TEST_F(Tables, ALineOfUnitsBelowTheNamesIsRead) {
  expect_two_poses(
      "time,x,y,z,qx,qy,qz,qw\ns,mm,mm,mm,,,,\n1000000000.0,1000,2000,3000,0,0,0.7071068,0.7071068\n"
      "1000000000.1,4000,5000,6000,0,0,0.7071068,0.7071068\n");
}

TEST_F(Tables, TheLineOfASpreadsheetIsNoRow) {
  expect_two_poses(
      "sep=;\nt;x;y;z;qx;qy;qz;qw\n1000000000,0;1;2;3;0;0;0,7071068;0,7071068\n"
      "1000000000,1;4;5;6;0;0;0,7071068;0,7071068\n");
}

/// What is before the rows has no meaning then.
TEST_F(Tables, ColumnsThatAreNamedByHandNeedNoHeader) {
  ReadOptions options;
  options.columns = "-,t,qx,qy,qz,qw,x,y,z,-";
  const std::string content = capture("Meters", "1,2,3", "4,5,6");
  expect_two_poses(content, options);
  EXPECT_THAT(read(content, options).notes, Contains(HasSubstr("lines 1 to 7 are not read")));
}

/// Rows that begin with a word, or with an empty field, are rows.
TEST_F(Tables, RowsWithOtherColumnsAreNotSkipped) {
  ReadOptions options;
  options.columns = "-,t,x,y,z,qx,qy,qz,qw";
  const std::string pose = ",0,0,0.7071068,0.7071068\n";
  expect_two_poses(",1000000000.0,1,2,3" + pose + "turn,1000000000.1,4,5,6" + pose, options);
  expect_two_poses("go,1000000000.0,1,2,3" + pose + "7,1000000000.1,4,5,6" + pose, options);
  options.columns = "t,x,y,z,qx,qy,qz,qw,-,-,-";
  const std::string words = ",0,0,0.7071068,0.7071068,a,b,c\n";
  expect_two_poses("1000000000.0,1,2,3" + words + "1000000000.1,4,5,6" + words, options);
}

/// Tracking that begins late: times without poses.
TEST_F(Tables, PosesThatAreLostAtTheBeginningAreNoNames) {
  const std::string lost = "999999999.8,,,,,,,\n999999999.9,,,,,,,\n";
  const TrajectoryReading reading =
      read("t,x,y,z,qx,qy,qz,qw\n" + lost + "1000000000.0,1,2,3,0,0,0,1\n1000000000.1,1,2,3,0,0,0,1\n");
  EXPECT_EQ(reading.trajectory.size(), 2u);
  EXPECT_EQ(reading.trajectory.front().time_us, 1'000'000'000'000'000);
  EXPECT_EQ(reading.losses.refused, 2u);
}

/// A header with a row that makes no sense below it.
TEST_F(Tables, ARowOfWordsIsStillAnError) {
  expect_error("t,x,y,z,qx,qy,qz,qw\na,b,c,d,e,f,g,h\n1,1,2,3,0,0,0,1\n", ":2:");
  expect_error("t,x,y,z,qx,qy,qz,qw\noops\n1,1,2,3,0,0,0,1\n", ":2:");
}

/// Columns one after the other hold the inverse rotation and no position.
TEST_F(Tables, APoseMatrixThatIsTransposedIsAnError) {
  const std::string row = "1 0 0 0 0 1 0 0 0 0 1 0 ";
  EXPECT_EQ(read(row + "0 0 0 1\n" + row + "0 0 0 1\n").trajectory.size(), 2u);
  expect_error(
      row + "0 0 0 1\n" + row + "0.5 2 3 1\n",
      ":2: field 13: expected 0 0 0 1 at the end of a 4 x 4 pose, got '0.5'; write the matrix row by row");
}

TEST_F(Tables, YamlIsNoTable) {
  for (const char* const text :
       {"%YAML:1.0\n---\nT: !!opencv-matrix\n", "---\n- a: 1\n", "header:\n  stamp:\n    sec: 1\n",
        "- robot:\n    x: 1\n", "eye_on_hand: true\nparameters:\n  a: 1\n"})
    expect_error(text, "is YAML, not a trajectory");
  const std::string rows =
      "1000000000.0 1 2 3 0 0 0.7071068 0.7071068\n1000000000.1 4 5 6 0 0 0.7071068 0.7071068\n";
  expect_two_poses("#units: m\n#frame: world\n" + rows);
  expect_two_poses("# t: s\n" + rows);
}

}  // namespace
}  // namespace egocal::test_io_titles
