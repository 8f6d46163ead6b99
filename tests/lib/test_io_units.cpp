// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Units of the columns of a table: converted where they are named, found or asked for where they are not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "../support/scratch_folder.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"

namespace egocal::test_io_units {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double degree = std::numbers::pi / 180;

class Units : public ::testing::Test {
 protected:
  TrajectoryReading read(const std::string& content, const std::string& columns = "") const {
    ReadOptions options;
    options.columns = columns;
    return read_trajectory_file(folder_.file("table.csv", content), options);
  }
  std::string refusal(const std::string& content, const std::string& columns = "") const {
    try {
      read(content, columns);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "accepted";
  }
  /// x of the second row of two.
  double second_x(const std::string& header, const std::string& columns = "") const {
    return to_pose(read((header.empty() ? "" : header + "\n") + "0,0,0,0\n1,1,0,0\n", columns)
                       .trajectory.back()
                       .pose)
        .translation.x();
  }
  testing::ScratchFolder folder_;
};

TEST_F(Units, LengthsAreConverted) {
  for (const auto& [unit, metres] : {std::pair{"m", 1.0},
                                     {"cm", 0.01},
                                     {"mm", 0.001},
                                     {"km", 1000.0},
                                     {"ft", 0.3048},
                                     {"feet", 0.3048},
                                     {"in", 0.0254},
                                     {"Inch", 0.0254},
                                     {"yd", 0.9144},
                                     {"mi", 1609.344},
                                     {"metres", 1.0},
                                     {"US-ft", 1200.0 / 3937}}) {
    const std::string x = "x[" + std::string(unit) + "]";
    EXPECT_DOUBLE_EQ(second_x("t," + x + ",y,yaw[rad]"), metres) << unit;
    EXPECT_DOUBLE_EQ(second_x("", "t," + x + ",y,yaw[rad]"), metres) << unit;
    EXPECT_DOUBLE_EQ(second_x("t,pos_x (map) (" + std::string(unit) + "),pos_y,yaw[rad]"), metres) << unit;
  }
  EXPECT_DOUBLE_EQ(second_x("t,x_ft,y_ft,yaw_rad"), 0.3048);
  EXPECT_DOUBLE_EQ(second_x("t_s,x_km,y_km,yaw_rad"), 1000);
}

TEST_F(Units, AnglesSpeedsAndTimesAreConverted) {
  const auto turned = [&](const std::string& yaw) {
    const TrajectoryReading reading = read("t,x,y," + yaw + "\n0,0,0,0\n1,1,0,1\n");
    return rotation_log(to_pose(reading.trajectory.back().pose).rotation).z();
  };
  EXPECT_NEAR(turned("yaw[rad]"), 1, 1e-12);
  EXPECT_NEAR(turned("yaw[mrad]"), 1e-3, 1e-12);
  EXPECT_NEAR(turned("yaw[Degrees]"), degree, 1e-12);
  EXPECT_NEAR(turned("yaw (\xc2\xb0)"), degree, 1e-12);
  EXPECT_NEAR(turned("yaw[gon]"), std::numbers::pi / 200, 1e-12);
  const auto way = [&](const std::string& speed, const std::string& rate) {
    const TrajectoryReading reading = read("t," + speed + "," + rate + "\n0,36,0\n1,36,0\n");
    return to_pose(reading.trajectory.back().pose).translation.x();
  };
  EXPECT_NEAR(way("v[m/s]", "yaw_rate[rad/s]"), 36, 1e-12);
  EXPECT_NEAR(way("v[km/h]", "yaw_rate[deg/s]"), 10, 1e-12);
  EXPECT_NEAR(way("speed_kmh", "wz_deg_s"), 10, 1e-12);
  EXPECT_NEAR(way("v[kn]", "yaw_rate[rpm]"), 36 * 1852.0 / 3600, 1e-12);
  const auto span_us = [&](const std::string& time) {
    return read(time + ",x,y,yaw[rad]\n0,0,0,0\n1000,1,0,1\n").trajectory.back().time_us;
  };
  EXPECT_EQ(span_us("t[msec]"), 1'000'000);
  EXPECT_EQ(span_us("t[\xc2\xb5s]"), 1'000);
  EXPECT_EQ(span_us("time (UTC) [s]"), 1'000'000'000);
  // 1e-3 rad of latitude are 6.3 km
  const TrajectoryReading at = read("t,lat[rad],lon[rad],yaw[rad]\n0,0,0,0\n1,0.001,0,0\n");
  EXPECT_NEAR(to_pose(at.trajectory.back().pose).translation.y(), 6335.4, 1);
}

TEST_F(Units, UnknownOnesAreRefusedByName) {
  const std::string row = "0,0,0,0\n1,1,0,0\n";
  EXPECT_THAT(
      refusal("t,x[furlong],y,yaw[rad]\n" + row),
      HasSubstr("table.csv:1: column 2 (x[furlong]): the unit 'furlong' is not known; expected m, dm"));
  EXPECT_THAT(refusal("t,x,y,yaw[rad]\n" + row, "t,x,y[ells],yaw[rad]"),
              HasSubstr("--columns: 'y[ells]': the unit 'ells' is not known; expected m,"));
  EXPECT_THAT(refusal("# t,x,y[ells],yaw[rad]\n" + row),
              HasSubstr("table.csv:1: column 3 (y[ells]): the unit"));
  EXPECT_THAT(refusal("t,x,y,yaw[m]\n" + row), HasSubstr("the unit 'm' is not known; expected rad,"));
  EXPECT_THAT(refusal("t[min],x,y,yaw[rad]\n" + row),
              HasSubstr("the unit 'min' is not known; expected s, ms"));
  EXPECT_THAT(refusal("t,v[m],yaw_rate\n0,1,0\n1,1,0\n"), HasSubstr("expected m/s,"));
  EXPECT_THAT(refusal("t,x,y,z,qx[deg],qy,qz,qw\n0,0,0,0,0,0,0,1\n"),
              HasSubstr("the unit 'deg' is not known"));
  // of columns that are not read any unit is right
  EXPECT_EQ(read("t,x,y,z,qx,qy,qz,qw,yaw[turtles]\n0,0,0,0,0,0,0,1,7\n").trajectory.size(), 1u);
}

TEST_F(Units, AColumnIsNamedOnce) {
  const std::string row = "0,0,0,0,0\n1,1,0,0,0\n";
  EXPECT_THAT(refusal("t,x,x,y,yaw[rad]\n" + row),
              HasSubstr("table.csv:1: column 3 (x): is the name of column 2 as well; name the one"));
  EXPECT_THAT(refusal("t,x[m],X_m,y,yaw[rad]\n" + row), HasSubstr("is the name of column 2 as well"));
  // the same in another unit is no contradiction
  EXPECT_THAT(read("t,x,y,yaw_deg,yaw_rad\n0,0,0,90,1.5708\n").notes,
              Contains(HasSubstr("yaw_deg (not yaw_rad)")));
  EXPECT_THAT(refusal(row, "t,x,y,y,yaw[rad]"),
              HasSubstr("--columns: 'y': is the name of column 3 as well; a"));
  // names of columns that are not read may come again
  EXPECT_EQ(read("t,x,y,yaw[rad],status,status\n0,0,0,0,1,1\n1,1,0,0,1,1\n").trajectory.size(), 2u);
  EXPECT_EQ(read("0,9,1,2,9,0\n1,9,1,2,9,0\n", "t,-,x,y,-,yaw[rad]").trajectory.size(), 2u);
  EXPECT_THAT(read("0,9,1,2,9,0\n", "t,odo,x,y,-,yaw[rad]").notes,
              ElementsAre(HasSubstr("--columns: 'odo' (-")));
  EXPECT_THAT(read("t,car.x,car.y,yaw[rad],van.x,van.y\n0,1,1,0,2,2\n").notes,
              Contains(HasSubstr("car.x (not van.x), car.y (not van.y)")));
}

/// A vehicle on a winding road: x, y in metres, its heading, ten rows a second.
struct Drive {
  double turn_rate = 0.1;  ///< [rad/s]
  bool holonomic = false;  ///< moves in any direction
  std::string text(double unit, bool wrapped, const std::string& yaw = "yaw") const {
    std::string rows = "t,x,y," + yaw + "\n";
    double x = 0, y = 0, heading = 0.3;
    for (int i = 0; i < 1200; ++i) {
      char row[200];
      const double seen = wrapped ? std::remainder(heading, 2 * std::numbers::pi) : heading;
      std::snprintf(row, sizeof row, "%.1f,%.6f,%.6f,%.9f\n", 0.1 * i, x, y, seen / unit);
      rows += row;
      const double direction = holonomic ? 2 * std::sin(0.05 * i) : heading;
      x += 0.5 * std::cos(direction);
      y += 0.5 * std::sin(direction);
      heading += 0.1 * turn_rate * (1 + 0.5 * std::sin(0.02 * i));
    }
    return rows;
  }
};

TEST_F(Units, SumsOfTurnsInRadiansAreNoDegrees) {
  const auto turn = [&](const std::string& text) {  // between the first two rows
    const Trajectory poses = read(text).trajectory;
    return rotation_log(to_pose(conjugate(poses[0].pose) * poses[1].pose).rotation).z();
  };
  const Drive slow;  // two turns in two minutes
  for (const bool wrapped : {false, true}) {
    EXPECT_NEAR(turn(slow.text(1, wrapped)), 0.01, 1e-6) << wrapped;
    EXPECT_NEAR(turn(slow.text(degree, wrapped)), 0.01, 1e-6) << wrapped;
  }
  EXPECT_THAT(read(slow.text(1, false)).notes, Contains(HasSubstr("radians, as the direction of travel")));
  EXPECT_THAT(read(slow.text(degree, false)).notes,
              Contains(HasSubstr("degrees, as the direction of travel")));
  // what turns by more than 15 a second turns in degrees, wherever it goes
  const Drive fast{0.4, true};
  EXPECT_NEAR(turn(fast.text(degree, false)), 0.04, 1e-6);
  EXPECT_NEAR(turn(fast.text(degree, true)), 0.04, 1e-6);
  EXPECT_NEAR(turn(fast.text(1, true)), 0.04, 1e-6);
}

TEST_F(Units, TheUnitOfAnglesIsAskedForWhereNothingTellsIt) {
  const Drive drive{0.2, true};
  EXPECT_THAT(
      refusal(drive.text(1, false)),
      HasSubstr("table.csv:1: yaw: cannot tell whether its angles are degrees or radians whose turns are "
                "summed; name the unit, [rad] or [deg]: --columns 't,x,y,yaw[rad]'"));
  EXPECT_THAT(read(drive.text(1, false), "t,x,y,yaw[rad]").notes, IsEmpty());
  EXPECT_THAT(read(drive.text(1, false, "yaw[rad]")).notes, IsEmpty());
}

TEST_F(Units, OfOneAngleIsThatOfTheOthers) {
  const TrajectoryReading reading = read("t,x,y,z,roll,pitch,yaw[deg]\n0,0,0,0,0,0,0\n1,1,0,0,2,0,0\n");
  EXPECT_NEAR(rotation_log(to_pose(reading.trajectory.back().pose).rotation).x(), 2 * degree, 1e-12);
  EXPECT_THAT(reading.notes, Contains(HasSubstr("in the unit of yaw[deg]")));
}

}  // namespace
}  // namespace egocal::test_io_units
