// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Mounts that move are found, with their time; what is not a moved mount is not called one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "../support/paths.hpp"
#include "../support/random_motion.hpp"
#include "../support/real_drives.hpp"
#include "../support/simulated_drive.hpp"
#include "../support/standing.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/moves/find_moves.hpp"
#include "egocal/online/answer.hpp"
#include "statistics/distributions.hpp"

namespace egocal {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

SimulationOptions drive(Terrain terrain, std::uint64_t seed, double seconds = 120) {
  SimulationOptions options;
  options.terrain = terrain;
  options.seed = seed;
  options.poses = static_cast<int>(10 * seconds) + 1;
  options.relative_noise = 0.01;
  options.T_vehicle_sensor = {testing::T_vehicle_a, testing::T_vehicle_b};
  options.faults.resize(2);
  return options;
}

/// Half a degree and 3 cm about an axis that depends on the seed.
MountChange bump(double time, std::uint64_t seed, double size = 1) {
  const double s = static_cast<double>(seed);
  const Eigen::Vector3d axis =
      Eigen::Vector3d(std::sin(s), std::cos(2 * s), std::sin(3 * s + 1)).normalized();
  return {time, time, {rotation_exp(size * 0.5 / degrees * axis), size * 0.03 * axis}};
}

MovesResult moves_of(const Trajectory& a, const Trajectory& b, PairingOptions pairing = {},
                     const MovesOptions& options = {}) {
  const Choice choice = pair_motions(pairing, a, b).drive.choice();
  pairing.balance = choice.balance;
  Problem problem;
  problem.mode = pairing.mode;
  problem.plane_a = pairing.plane_a;
  problem.plane_b = pairing.plane_b;
  problem.balance = choice.balance;
  std::vector<std::vector<MotionPair>> strides;
  for (const int stride : {1, choice.stride}) {
    pairing.stride = stride;
    strides.push_back(pair_motions(pairing, a, b).pairs);
  }
  return find_moves_of_strides(strides, problem, options);
}

MovesResult moves_of(const SimulationOptions& options) {
  const auto trajectories = simulate(options);
  return moves_of(trajectories[0], trajectories[1]);
}

TEST(Distributions, TailsOfFAreRight) {
  for (const double f : {0.1, 1.0, 4.0, 50.0}) {
    EXPECT_NEAR(detail::f_exceeded(f, 1, 1), 1 - 2 / std::numbers::pi * std::atan(std::sqrt(f)), 1e-11) << f;
    // P(F(d, 2) > f) = 1 - (d f / (2 + d f))^(d / 2)
    EXPECT_NEAR(detail::f_exceeded(f, 6, 2), 1 - std::pow(6 * f / (2 + 6 * f), 3), 1e-11) << f;
  }
  EXPECT_EQ(detail::f_exceeded(-1, 6, 40), 1);
  EXPECT_EQ(detail::f_exceeded(1, 6, 0), 1);
  // P(F(2, d) > f) = (1 + 2 f / d)^(-d / 2)
  for (const double f : {0.1, 1.0, 5.0, 20.0})
    EXPECT_NEAR(detail::f_exceeded(f, 2, 30) / std::pow(1 + 2 * f / 30, -15), 1, 1e-10) << f;
}

TEST(Moves, ABumpIsFoundWithItsTimeAndSize) {
  int found = 0, in_interval = 0, drives = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
      for (const double part : {0.2, 0.5, 0.8}) {
        ++drives;
        SimulationOptions options = drive(terrain, 100 + seed, 240);
        const double time = part * 240 + 0.05;
        options.faults[1].mount_changes = {bump(time, seed)};
        const MovesResult result = moves_of(options);
        EXPECT_TRUE(result.tested);
        EXPECT_LE(result.moves.size(), 1u);
        if (result.moves.size() != 1) continue;
        ++found;
        const Move& move = result.moves.front();
        EXPECT_EQ(move.kind, MoveKind::bump);
        EXPECT_LT(std::abs(move.time - time), 15);
        EXPECT_LE(move.earliest, move.time);
        EXPECT_GE(move.latest, move.time);
        in_interval += move.earliest - 0.5 <= time && time <= move.latest + 0.5;
        const auto error =
            extrinsic_error(to_dual_quaternion(true_extrinsic(options, 0, 1, 239)), move.after);
        EXPECT_LT(error.rotation * degrees, 0.3);
      }
    }
  }
  EXPECT_GE(found, drives - 2);
  EXPECT_GE(in_interval, found - 1);
}

TEST(Moves, AStillMountRaisesNoAlarmWhateverTheNoise) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const Terrain terrain : {Terrain::rough, Terrain::free, Terrain::flat})
      for (int noise = 0; noise < 3; ++noise) {
        SimulationOptions options = drive(terrain, 200 + seed);
        options.random_walk = noise == 1;
        options.heavy_tails = noise == 2;
        EXPECT_TRUE(moves_of(options).moves.empty()) << seed << " noise " << noise;
      }
}

TEST(Moves, NoiseThatGrowsWithEachMotionIsNone) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const Terrain terrain : {Terrain::rough, Terrain::flat}) {
      SimulationOptions options = drive(terrain, 700 + seed, seed % 2 == 0 ? 60 : 200);
      options.speed = 5;
      options.speed_variation = 1;
      options.relative_noise = 0;
      options.noise_of_motion = 0.01;
      EXPECT_TRUE(moves_of(options).moves.empty()) << seed;
    }
}

TEST(Moves, AJumpOfOneOdometryIsNotAMovedMount) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SimulationOptions options = drive(Terrain::rough, 300 + seed);
    options.faults[1].jumps = {{40.05, {rotation_exp({0, 0, 0.1}), {0.5, 0.2, 0}}},
                               {80.05, {rotation_exp({0.01, 0, 0}), {0, 0.1, 0}}}};
    EXPECT_TRUE(moves_of(options).moves.empty()) << seed;
  }
}

/// What motions of one stride alone show are errors of that length: stamps that jitter while a robot turns.
TEST(Moves, EvidenceIsThatOfTwoStrides) {
  SimulationOptions still = drive(Terrain::rough, 3), bumped = still;
  bumped.faults[1].mount_changes = {bump(60, 3, 3)};
  const auto pairs_of = [](const SimulationOptions& options, int stride) {
    const auto trajectories = simulate(options);
    PairingOptions pairing;
    pairing.stride = stride;
    return pair_motions(pairing, trajectories[0], trajectories[1]).pairs;
  };
  Problem problem;
  problem.balance = {1, 1};
  const auto chance = [&](const std::vector<std::vector<MotionPair>>& strides) {
    return find_moves_of_strides(strides, problem).chance;
  };
  EXPECT_LT(chance({pairs_of(bumped, 2), pairs_of(bumped, 5)}), 1e-10);
  EXPECT_GT(chance({pairs_of(bumped, 2), pairs_of(still, 5)}), 1e-5);
  EXPECT_LT(chance({pairs_of(bumped, 2)}), 1e-10);
}

TEST(Moves, SeveralBumpsAreDistinguished) {
  SimulationOptions options = drive(Terrain::free, 400, 400);
  for (int i = 0; i < 3; ++i)
    options.faults[1].mount_changes.push_back(bump(100 * (i + 1) + 0.05, static_cast<std::uint64_t>(i), 3));
  const MovesResult result = moves_of(options);
  ASSERT_EQ(result.moves.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(result.moves[i].kind, MoveKind::bump);
    EXPECT_NEAR(result.moves[i].time, 100.0 * static_cast<double>(i + 1), 3);
  }
}

TEST(Moves, NoiseThatWandersForLongerThanABlockIsNone) {
  SimulationOptions options = drive(Terrain::rough, 9343, 60);  // one of 1,500 that were tried
  options.random_walk = true;
  options.relative_noise = 0.03;
  const auto trajectories = simulate(options);
  MovesOptions short_blocks;
  short_blocks.most_correlation = INFINITY;
  EXPECT_EQ(moves_of(trajectories[0], trajectories[1], {}, short_blocks).moves.size(), 1u);
  EXPECT_TRUE(moves_of(trajectories[0], trajectories[1]).moves.empty());
}

TEST(Moves, FifteenSecondsShowABump) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed)
    for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
      SimulationOptions options = drive(terrain, 600 + seed, 135);
      options.faults[1].mount_changes = {bump(120, seed)};
      const MovesResult result = moves_of(options);
      ASSERT_LE(result.moves.size(), 1u);
      if (result.moves.empty()) continue;
      ++found;
      EXPECT_NEAR(result.moves[0].time, 120, 8);
    }
  EXPECT_GE(found, 27) << "of 30; 960 of 1000 in moves_study";
}

TEST(Moves, AChangeShowsWhereverItLiesWithinABlock) {
  for (double time = 118; time <= 121; time += 0.5) {
    SimulationOptions options = drive(Terrain::free, 645, 135);
    options.faults[1].mount_changes = {bump(time, 7)};
    const auto trajectories = simulate(options);
    PairingOptions pairing;
    pairing.stride = 16;  // 27 blocks of 4.9 s, three of them after the change
    const std::vector<MotionPair> pairs = pair_motions(pairing, trajectories[0], trajectories[1]).pairs;
    const std::int64_t begin_us = pairs.front().begin_us;
    const auto time_us = begin_us + static_cast<std::int64_t>(1e6 * time);
    const std::optional<double> chance = chance_of_move(pairs, Problem{}, MoveKind::bump, time_us);
    ASSERT_TRUE(chance);
    EXPECT_LT(*chance, 1e-6) << time << ": with the block after the change alone it is 1e-2";
    EXPECT_FALSE(chance_of_move(std::span(pairs).first(100), Problem{}, MoveKind::bump, begin_us))
        << "too few blocks";
  }
}

/// A quarter of the drive at lights, where the odometry has other errors than on the way.
TEST(Moves, AVehicleThatStopsOftenHasNotMovedItsMount) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const double jitter : {0.0, 1e-3})
      for (const bool moved : {false, true}) {
        SimulationOptions options = drive(terrain, 700);
        if (moved) options.faults[1].mount_changes = {bump(60.05, 2, 3)};
        auto trajectories = simulate(options);
        testing::Random random(5);
        for (const std::size_t at : {1000u, 800u, 600u, 400u, 200u})
          for (Trajectory& one : trajectories)
            one = testing::with_stand(one, at, 400, 100'000, jitter, random);
        const MovesResult result = moves_of(trajectories[0], trajectories[1]);
        ASSERT_EQ(result.moves.size(), moved ? 1u : 0u) << jitter;
        if (!moved) continue;
        EXPECT_LE(result.moves[0].earliest, 140.1);  // stood from 140 to 180 s
        EXPECT_GE(result.moves[0].latest, 140.1);
      }
}

TEST(Moves, SlowCreepIsCalledThat) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    SimulationOptions options = drive(terrain, 500, 300);
    options.faults[1].mount_changes = {{0, 300, {rotation_exp({0, 2 / degrees, 0}), {0, 0, 0}}}};
    const MovesResult result = moves_of(options);
    ASSERT_EQ(result.moves.size(), 1u);
    const Move& move = result.moves.front();
    EXPECT_EQ(move.kind, MoveKind::creep);
    const Eigen::Vector3d turned(move.change[3], move.change[4], move.change[5]);
    EXPECT_NEAR(turned.norm() * degrees, 2, 0.4);
  }
}

TEST(Moves, TwoDegreesOfCreepInAnHourAreTracked) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    SimulationOptions options = drive(terrain, 510, 1200);
    options.faults[1].mount_changes = {{0, 3600, {rotation_exp({0, 2 / degrees, 0}), {0, 0, 0}}}};
    const MovesResult result = moves_of(options);
    ASSERT_EQ(result.moves.size(), 1u);
    EXPECT_EQ(result.moves[0].kind, MoveKind::creep);
    const std::array<double, 6>& change = result.moves[0].change;
    EXPECT_NEAR(Eigen::Vector3d(change[3], change[4], change[5]).norm() * degrees, 2.0 / 3, 0.2);
  }
}

TEST(Moves, CreepIsCalledThatWhereADriveIsNotKeptEvenly) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    SimulationOptions options = drive(terrain, 520, 1200);
    options.faults[1].mount_changes = {{0, 1200, {rotation_exp({0, 2 / degrees, 0}), {0, 0, 0}}}};
    const std::vector<Trajectory> sensors = simulate(options);
    PairingOptions pairing;
    pairing.stride = 1;
    pairing.balance = Balance{};
    std::vector<MotionPair> pairs = pair_motions(pairing, sensors[0], sensors[1]).pairs;
    // as egocal-diagnosis does: one of four stretches of five seconds, and the newest in full
    std::erase_if(pairs, [&](const MotionPair& pair) {
      const double seconds = 1e-6 * static_cast<double>(pair.begin_us - pairs.front().begin_us);
      return seconds < 1140 && static_cast<int>(seconds / 5) % 4 != 0;
    });
    const MovesResult result = find_moves(pairs, {});
    ASSERT_EQ(result.moves.size(), 1u);
    EXPECT_EQ(result.moves[0].kind, MoveKind::creep);
    const std::array<double, 6>& change = result.moves[0].change;
    EXPECT_NEAR(Eigen::Vector3d(change[3], change[4], change[5]).norm() * degrees, 2, 0.3);
  }
}

/// A drive of a vehicle that goes straight on from one pose to another one: the poses of both sensors, b with
/// its mount bumped at one of them, each with its own noise of 1 %.
testing::Streams with_straight_part(std::uint64_t seed, std::size_t from, std::size_t to, std::size_t bumped,
                                    const Pose& change) {
  SimulationOptions options;
  options.terrain = Terrain::rough;
  options.seed = seed;
  options.poses = 1201;
  options.T_vehicle_sensor = {Pose{}};
  const Trajectory vehicle = simulate(options)[0];
  testing::Random random(seed);
  testing::Streams streams;
  DualQuaternion at, mount_b = to_dual_quaternion(testing::T_vehicle_b);
  const DualQuaternion mount_a = to_dual_quaternion(testing::T_vehicle_a);
  DualQuaternion a, b, mount_before = mount_b;
  for (std::size_t i = 0; i < vehicle.size(); ++i) {
    if (i > 0) {
      const bool straight = i > from && i <= to;
      const DualQuaternion step = straight
                                      ? to_dual_quaternion(Pose{Eigen::Quaterniond::Identity(), {0.8, 0, 0}})
                                      : conjugate(vehicle[i - 1].pose) * vehicle[i].pose;
      if (i == bumped) mount_b = mount_b * to_dual_quaternion(change);
      const auto noise = [&] {
        return to_dual_quaternion(Pose{rotation_exp(random.normal3(0.0003)), random.normal3(0.006)});
      };
      a = normalized(a * (conjugate(mount_a) * step * mount_a) * noise());
      b = normalized(b * (conjugate(mount_before) * step * mount_b) * noise());
      mount_before = mount_b;
    }
    streams.a.push_back({vehicle[i].time_us, a});
    streams.b.push_back({vehicle[i].time_us, b});
  }
  return streams;
}

TEST(Moves, ABumpWhileDrivingStraightIsFoundAtTheNextTurns) {
  const Pose change{rotation_exp({0, 0.3 / degrees, 1 / degrees}), {0.06, 0, 0}};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const testing::Streams streams = with_straight_part(seed, 500, 700, 600, change);
    const MovesResult result = moves_of(streams.a, streams.b);
    ASSERT_EQ(result.moves.size(), 1u) << seed;
    const Move& move = result.moves[0];
    EXPECT_LT(std::abs(move.time - 60), 13) << seed;
    EXPECT_LE(move.earliest, 61);
    EXPECT_GE(move.latest, 59);
    const testing::Streams still = with_straight_part(seed, 500, 700, 5000, change);
    EXPECT_TRUE(moves_of(still.a, still.b).moves.empty()) << seed;
  }
}

TEST(Moves, TheAnswerAfterItIsAsGoodAsThatOfANewDrive) {
  double after = 0, anew = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SimulationOptions options = drive(seed % 2 ? Terrain::rough : Terrain::free, 1000 + seed);
    options.faults[1].mount_changes = {bump(60.05, seed, 4)};
    std::vector<Trajectory> sensors = simulate(options);
    const MovesResult result = moves_of(sensors[0], sensors[1]);
    ASSERT_EQ(result.moves.size(), 1u) << seed;
    for (Trajectory& sensor : sensors)
      std::erase_if(sensor, [](const StampedPose& pose) { return pose.time_us < 60'050'000; });
    const DualQuaternion truth = to_dual_quaternion(true_extrinsic(options, 0, 1, 119));
    const Problem problem = pair_motions({}, sensors[0], sensors[1]).drive.problem();
    after += extrinsic_error(truth, result.moves[0].after).rotation;
    anew += extrinsic_error(truth, solve(problem, Method::dual).T_a_b).rotation;
  }
  RecordProperty("after_deg", std::to_string(after / 6 * degrees));
  RecordProperty("new_deg", std::to_string(anew / 6 * degrees));
  EXPECT_LT(after, 1.3 * anew) << after / 6 * degrees << " deg against " << anew / 6 * degrees;
}

TEST(Moves, ALargeBumpHalfWayDoesNotHideBehindTheOutlierTest) {
  SimulationOptions options = drive(Terrain::rough, 600);
  options.faults[1].mount_changes = {{60.05, 60.05, {rotation_exp({0, 0, 10 / degrees}), {0.3, 0, 0}}}};
  const MovesResult result = moves_of(options);
  ASSERT_EQ(result.moves.size(), 1u);
  EXPECT_NEAR(result.moves.front().time, 60, 1.5);
  const Move& move = result.moves.front();
  EXPECT_LT(
      extrinsic_error(to_dual_quaternion(true_extrinsic(options, 0, 1, 0)), move.before).rotation * degrees,
      0.5);
  EXPECT_LT(
      extrinsic_error(to_dual_quaternion(true_extrinsic(options, 0, 1, 119)), move.after).rotation * degrees,
      0.5);
}

TEST(Moves, PlanarModeFindsAYaw) {
  SimulationOptions options = drive(Terrain::flat, 700, 200);
  options.T_vehicle_sensor = {Pose{Eigen::Quaterniond::Identity(), {1, 0, 1.8}},
                              Pose{rotation_exp({0, 0, 0.4}), {1.5, -0.4, 1.5}}};
  options.faults[1].mount_changes = {{100.05, 100.05, {rotation_exp({0, 0, 1 / degrees}), {0, 0, 0}}}};
  const auto trajectories = simulate(options);
  PairingOptions planar;
  planar.mode = Mode::planar;
  planar.plane_a = {{0, 0, 1}, -1.8};
  planar.plane_b = {{0, 0, 1}, -1.5};
  const MovesResult result = moves_of(trajectories[0], trajectories[1], planar);
  ASSERT_EQ(result.moves.size(), 1u);
  EXPECT_NEAR(result.moves.front().time, 100, 5);
  EXPECT_NEAR(result.moves.front().change[5] * degrees, 1, 0.15);
}

TEST(Moves, ALargeBumpIsFoundInAHundredMotions) {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SimulationOptions options = drive(seed % 2 == 0 ? Terrain::rough : Terrain::free, seed, 12);
    options.faults[1].mount_changes = {bump(6, seed, 10)};
    const MovesResult result = moves_of(options);
    EXPECT_TRUE(result.tested);
    if (result.moves.size() == 1 && std::abs(result.moves[0].time - 6) < 1) ++found;
  }
  EXPECT_GE(found, 5u);
}

// Neighbouring blocks are alike, and there are too few motions for longer ones. Of 400 such drives these had
// an alarm at the chance that holds for blocks of eight motions.
TEST(Moves, NoiseThatWandersIsNoneInAHundredMotions) {
  for (const std::uint64_t seed : {4u, 24u, 80u, 192u, 302u}) {
    SimulationOptions options = drive(seed % 2 == 0 ? Terrain::rough : Terrain::free, seed, 12);
    options.random_walk = true;
    EXPECT_TRUE(moves_of(options).moves.empty()) << seed;
  }
}

TEST(Moves, TooShortADriveIsNotJudged) {
  SimulationOptions options = drive(Terrain::rough, 800, 5);
  EXPECT_FALSE(moves_of(options).tested);
  EXPECT_FALSE(find_moves({}, {}).tested);
  // nothing moves at all
  const std::vector<MotionPair> still(1000);
  EXPECT_TRUE(find_moves(still, {}).moves.empty());
}

TEST(Moves, TheSameDriveGivesTheSameBits) {
  SimulationOptions options = drive(Terrain::rough, 900);
  options.faults[1].mount_changes = {bump(60, 1, 2)};
  const MovesResult x = moves_of(options), y = moves_of(options);
  ASSERT_EQ(x.moves.size(), 1u);
  ASSERT_EQ(y.moves.size(), 1u);
  EXPECT_EQ(x.moves[0].false_alarm, y.moves[0].false_alarm);
  EXPECT_EQ(x.moves[0].change, y.moves[0].change);
}

TEST(Moves, NoRealDriveRaisesAnAlarm) {
  if (!testing::have_real_drives()) GTEST_SKIP() << "real drives are not at " << paths::data_dir();
  std::vector<testing::Streams> drives = {testing::euroc(), testing::robot_arm(),
                                          testing::kitti_asynchronous()};
  for (const char* name : {"05", "07"}) {
    drives.push_back(testing::kitti(name));
    drives.push_back(testing::planar(testing::kitti(name)));
    drives.push_back(testing::kitti(name, "velodyne_aloam"));
    testing::Streams lidars = testing::kitti(name);
    lidars.b = testing::real_trajectory(std::string("kitti_") + name + "/velodyne_aloam.tum");
    drives.push_back(lidars);
  }
  for (const auto& [a, b] : {std::pair{"mars", "nero"}, std::pair{"caligula", "nero"}}) {
    testing::Streams tango;
    tango.a = testing::real_trajectory(std::string("eth_tango_easy/") + a + ".tum");
    tango.b = testing::real_trajectory(std::string("eth_tango_easy/") + b + ".tum");
    drives.push_back(tango);
  }
  for (std::size_t i = 0; i < drives.size(); ++i)
    EXPECT_TRUE(moves_of(drives[i].a, drives[i].b, drives[i].options).moves.empty()) << i;
}

TEST(Moves, ABumpOfARealCameraIsFound) {
  if (!testing::have_real_drives()) GTEST_SKIP() << "real drives are not at " << paths::data_dir();
  testing::Streams streams = testing::kitti("07");
  const std::size_t half = streams.b.size() / 2;
  const DualQuaternion change = to_dual_quaternion({rotation_exp({0, 1.5 / degrees, 0}), {0.05, 0, 0}});
  for (std::size_t i = half; i < streams.b.size(); ++i)
    streams.b[i].pose = normalized(streams.b[i].pose * change);
  const double time = 1e-6 * static_cast<double>(streams.b[half].time_us - streams.b.front().time_us);
  const MovesResult result = moves_of(streams.a, streams.b, streams.options);
  ASSERT_EQ(result.moves.size(), 1u);
  EXPECT_NEAR(result.moves.front().time, time, 5);
}

}  // namespace
}  // namespace egocal
