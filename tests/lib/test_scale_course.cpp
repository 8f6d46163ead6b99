// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A scale that changes along the drive is found, with its extrinsic; one that does not is left alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "../support/real_drives.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/scale/estimate_scale.hpp"
#include "egocal/scale/scale_course.hpp"

namespace egocal::test_scale_course {
namespace {

SimulationOptions drive(std::uint64_t seed, Terrain terrain = Terrain::rough, int poses = 1801) {
  SimulationOptions options;
  options.terrain = terrain;
  options.seed = seed;
  options.poses = poses;
  options.relative_noise = 0.01;
  options.T_vehicle_sensor = {testing::T_vehicle_a, testing::T_vehicle_b};
  options.faults.resize(2);
  return options;
}

ScaleCourse course_of(const Trajectory& a, const Trajectory& b) {
  return find_scale_course(a, b, {}, estimate_scale(a, b).value(), Side::a);
}

/// From this time on [s] the steps are shorter by the factor, as after a loop closure of a monocular SLAM.
Trajectory stepped(const Trajectory& trajectory, double time, double factor) {
  ScaleCourse course;
  const std::int64_t begin = trajectory.front().time_us, at = begin + std::llround(1e6 * time);
  course.segments = {{begin, at, 1, 1, 0}, {at, trajectory.back().time_us, 1 / factor, 1 / factor, 0}};
  return scaled(trajectory, course);
}

// Blocks of equal time in which the vehicle stands showed no scale, and the search ended there.
TEST(ScaleCourse, AStepIsFoundWhereTheVehicleStandsInBetween) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SimulationOptions options = drive(seed, Terrain::rough, 901);
    options.speed = 5;
    options.speed_variation = 2;
    const auto trajectories = simulate(options);
    const Trajectory slow = stepped(trajectories[0], 45, 1.3);
    const ScaleCourse course = course_of(slow, trajectories[1]);
    ASSERT_EQ(course.segments.size(), 2u) << seed;
    EXPECT_NEAR(course.segments[1].begin_scale / course.segments[0].begin_scale, 1.3, 0.01) << seed;
  }
}

/// The faster stream is interpolated along screws, and the other one stays as it is.
PairingOptions along_screws() {
  PairingOptions options;
  options.synchroniser.smooth_poses = 0;
  options.synchroniser.cut_alike = false;
  return options;
}

// Each stream lies between the poses of the other one, and motions change between two poses: where one stream
// alone loses by interpolation, the scale is off by 1 % at 4 Hz, 13 standard deviations of the noise.
TEST(EstimateScale, InterpolationTakesNothingOff) {
  for (const double rate : {4.0, 10.0})
    for (const double noise : {0.01, 0.001}) {
      double off = 0, off_not_cut = 0;
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(std::to_string(rate) + " Hz, seed " + std::to_string(seed));
        SimulationOptions options = drive(seed, Terrain::free, 4801);
        options.rate = 40;
        options.relative_noise = noise;
        for (SensorFaults& faults : options.faults) faults.rate = rate;
        options.faults[1].phase = 0.37 / rate;
        const auto sensors = simulate(options);
        const Trajectory a = scaled(sensors[0], 0.4);
        const ScaleSolution found = estimate_scale(a, sensors[1]).value(),
                            not_cut = estimate_scale(a, sensors[1], along_screws()).value();
        EXPECT_TRUE(found.certified);
        EXPECT_NEAR(found.scale, 2.5, 0.002 * 2.5);
        EXPECT_NEAR(found.scale, 2.5, 2.5 * found.stddev);
        EXPECT_NEAR(not_cut.scale, 2.5, 2.5 * not_cut.stddev);
        off += std::abs(found.scale / 2.5 - 1);
        off_not_cut += std::abs(not_cut.scale / 2.5 - 1);
      }
      std::printf("%g Hz, noise of %g: off by %.3f %%, along screws %.3f %%\n", rate, noise, 25 * off,
                  25 * off_not_cut);
      EXPECT_LT(off, off_not_cut / 3);
    }
}

TEST(EstimateScale, StreamsMeasuredTogetherAreNotInterpolated) {
  const auto sensors = simulate(drive(1, Terrain::free));
  const ScaleSolution found = estimate_scale(sensors[0], sensors[1]).value();
  const ScaleSolution not_cut = estimate_scale(sensors[0], sensors[1], along_screws()).value();
  EXPECT_EQ(found.scale, not_cut.scale);
  EXPECT_EQ(found.stddev, not_cut.stddev);
}

TEST(ScaleCourse, AStepIsFoundWithItsTimeAndBothScales) {
  int found = 0, drives = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const Terrain terrain : {Terrain::rough, Terrain::free})
      for (const double factor : {1.08, 0.7}) {
        ++drives;
        const SimulationOptions options = drive(seed, terrain);
        const auto sensors = simulate(options);
        const Trajectory a = stepped(sensors[0], 100, factor);
        const ScaleCourse course = course_of(a, sensors[1]);
        if (course.segments.size() != 2) continue;
        ++found;
        EXPECT_NEAR(1e-6 * static_cast<double>(course.segments[1].begin_us - a.front().time_us), 100, 3);
        EXPECT_NEAR(course.segments[0].begin_scale, 1, 0.005);
        EXPECT_NEAR(course.segments[1].begin_scale, factor, 0.005 * factor);
      }
  EXPECT_EQ(found, drives);
}

/// From each of these times [s] the lengths must be multiplied by another factor: it is factors[0] before.
Trajectory stepping(const Trajectory& trajectory, const std::vector<double>& times,
                    const std::vector<double>& factors) {
  ScaleCourse course;
  std::int64_t from = trajectory.front().time_us;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const std::int64_t to = i < times.size() ? trajectory.front().time_us + std::llround(1e6 * times[i])
                                             : trajectory.back().time_us;
    course.segments.push_back({from, to, 1 / factors[i], 1 / factors[i], 0});
    from = to;
  }
  return scaled(trajectory, course);
}

// While single steps alone were tested, each change passed for noise that wanders: none was found, and the
// answer was good and off by up to 1.6 m.
TEST(ScaleCourse, ChangesThatTakeEachOtherBackAreAllFound) {
  struct Case {
    std::vector<double> times, factors;
  };
  for (const double factor : {0.7, 1.1, 1.25, 1.4})
    for (const Case& all :
         {Case{{60, 120}, {1, factor, 1}}, Case{{60, 120}, {1, factor, 1 / factor}},
          Case{{40, 80, 130}, {1, factor, 1, factor}}, Case{{30, 70, 110, 150}, {1, factor, 1, factor, 1}}})
      for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
        SCOPED_TRACE(std::to_string(factor) + ", " + std::to_string(all.times.size()) + " changes");
        const auto sensors = simulate(drive(4, terrain));
        const Trajectory a = stepping(sensors[0], all.times, all.factors);
        const ScaleCourse course = course_of(a, sensors[1]);
        ASSERT_EQ(course.segments.size(), all.factors.size());
        for (std::size_t i = 0; i < all.factors.size(); ++i) {
          EXPECT_NEAR(course.segments[i].begin_scale, all.factors[i], 0.01 * all.factors[i]);
          if (i == 0) continue;
          EXPECT_NEAR(1e-6 * static_cast<double>(course.segments[i].begin_us - a.front().time_us),
                      all.times[i - 1], 3);
        }
      }
}

// One more change than is tested together leaves a stretch with fewer, once another one is found.
TEST(ScaleCourse, AScaleThatSwaysIsFollowed) {
  const auto sensors = simulate(drive(6, Terrain::free));
  std::vector<double> times, factors{1};
  for (int i = 1; i < 60; ++i) {
    times.push_back(3 * i);
    factors.push_back(std::exp(0.2 * std::sin(2 * std::numbers::pi * i / 40)));
  }
  const Trajectory a = stepping(sensors[0], times, factors);
  const ScaleCourse course = course_of(a, sensors[1]);
  double off = 0;
  for (std::size_t i = 0; i < factors.size(); ++i)
    off += std::abs(std::log(
        course.at(a.front().time_us + std::llround(1e6 * (3 * static_cast<double>(i) + 1.5))) / factors[i]));
  EXPECT_LT(off / static_cast<double>(factors.size()), 0.03);  // 0.12 at one scale
}

TEST(ScaleCourse, AnEvenDriftIsFollowed) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    SimulationOptions options = drive(7, terrain);
    options.faults[0].scale = 3;
    options.faults[0].scale_drift = 0.2 / 180;  // 20 % in the three minutes
    const auto sensors = simulate(options);
    const ScaleCourse course = course_of(sensors[0], sensors[1]);
    ASSERT_TRUE(course.changes());
    for (const double time : {10.0, 90.0, 170.0})
      EXPECT_NEAR(course.at(sensors[0].front().time_us + std::llround(1e6 * time)) /
                      (3 * std::exp(options.faults[0].scale_drift * time)),
                  1, 0.015)
          << time;
  }
}

TEST(ScaleCourse, AScaleThatStaysIsLeftAlone) {
  for (std::uint64_t seed = 20; seed < 40; ++seed) {
    SimulationOptions options = drive(seed, seed % 2 ? Terrain::rough : Terrain::free, 1201);
    options.random_walk = seed % 3 == 1;
    options.heavy_tails = seed % 3 == 2;
    options.faults[0].scale = 0.37;
    const auto sensors = simulate(options);
    EXPECT_FALSE(course_of(sensors[0], sensors[1]).changes()) << seed;
  }
}

TEST(ScaleCourse, NoRealDriveWithAKnownScaleChanges) {
  if (!testing::have_real_drives()) GTEST_SKIP() << "no real drives at " << paths::data_dir();
  for (const std::string drive : {"kitti_05", "kitti_07"})
    EXPECT_FALSE(course_of(testing::real_trajectory(drive + "/cam0_orbslam2.tum"),
                           testing::real_trajectory(drive + "/velodyne_pylidar.tum"))
                     .changes())
        << drive;
}

TEST(ScaleCourse, APlanarDriveHasSegmentsToo) {
  for (const double factor : {1.0, 1.2}) {
    SimulationOptions options = drive(5, Terrain::flat);
    options.T_vehicle_sensor = {Pose{Eigen::Quaterniond::Identity(), {1, 0, 1.8}},
                                Pose{rotation_exp({0, 0, 0.4}), {1.5, -0.4, 1.5}}};
    const auto sensors = simulate(options);
    const Trajectory a = stepped(sensors[0], 100, factor);
    PairingOptions planar;
    planar.mode = Mode::planar;
    planar.plane_a = {{0, 0, 1}, -1.8};
    planar.plane_b = {{0, 0, 1}, -1.5};
    const ScaleSolution solution = estimate_scale(a, sensors[1], planar).value();
    ASSERT_TRUE(solution.observable);
    const ScaleCourse course = find_scale_course(a, sensors[1], planar, solution, Side::a);
    ASSERT_EQ(course.segments.size(), factor == 1 ? 1u : 2u);
    EXPECT_NEAR(course.segments[0].begin_scale, 1, 0.005);
    EXPECT_NEAR(course.segments.back().begin_scale, factor, 0.005 * factor);
    if (factor != 1) {
      EXPECT_NEAR(1e-6 * static_cast<double>(course.segments[1].begin_us - a.front().time_us), 100, 3);
    }
  }
}

TEST(ScaleCourse, TooShortADriveHasOneScale) {
  const auto sensors = simulate(drive(1, Terrain::free, 60));
  const ScaleCourse course = course_of(sensors[0], sensors[1]);
  EXPECT_EQ(course.segments.size(), 1u);
  EXPECT_FALSE(course.changes());
}

}  // namespace
}  // namespace egocal::test_scale_course
