// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Mounts that move are found, with their time and by how much.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/moved_drive.hpp"
#include "../support/paths.hpp"
#include "../support/real_drives.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"

namespace egocal::test_moves {
namespace {

using testing::bump;
using testing::degrees;
using testing::moved_drive;
using testing::moves_of;
using testing::with_wandering_errors;

TEST(Moves, ABumpIsFoundWithItsTimeAndSize) {
  int found = 0, in_interval = 0, drives = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
      for (const double part : {0.2, 0.5, 0.8}) {
        ++drives;
        SimulationOptions options = moved_drive(terrain, 100 + seed, 240);
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

/// What motions of one stride alone show are errors of that length: stamps that jitter while a robot turns.
TEST(Moves, EvidenceIsThatOfTwoStrides) {
  SimulationOptions still = moved_drive(Terrain::rough, 3), bumped = still;
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

/// In a short drive, noise that is remembered for seconds has few independent parts, so its memory is a
/// guess. 17 of these 60 drives had a certain move before, now 6.
TEST(Moves, NoiseThatWandersThroughAShortDriveIsNoCertainMove) {
  const auto moved_for_certain = [](const MovesResult& result) {
    return std::any_of(result.moves.begin(), result.moves.end(),
                       [](const Move& move) { return move.certain; });
  };
  int still = 0, bumped = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SimulationOptions options = moved_drive(seed % 2 == 0 ? Terrain::rough : Terrain::free, 5000 + seed, 30);
    options.relative_noise = 0.005;
    const auto streams = simulate(options);
    still += !moved_for_certain(moves_of(with_wandering_errors(streams[0], seed), streams[1]));
    if (seed > 10) continue;
    options.faults[1].mount_changes = {bump(15.05, seed, 8)};
    const auto moved = simulate(options);
    bumped += moved_for_certain(moves_of(with_wandering_errors(moved[0], seed), moved[1]));
  }
  EXPECT_GE(still, 52);
  EXPECT_EQ(bumped, 10);
}

TEST(Moves, SeveralBumpsAreDistinguished) {
  SimulationOptions options = moved_drive(Terrain::free, 400, 400);
  for (int i = 0; i < 3; ++i)
    options.faults[1].mount_changes.push_back(bump(100 * (i + 1) + 0.05, static_cast<std::uint64_t>(i), 3));
  const MovesResult result = moves_of(options);
  ASSERT_EQ(result.moves.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(result.moves[i].kind, MoveKind::bump);
    EXPECT_NEAR(result.moves[i].time, 100.0 * static_cast<double>(i + 1), 3);
  }
}

TEST(Moves, FifteenSecondsShowABump) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed)
    for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
      SimulationOptions options = moved_drive(terrain, 600 + seed, 135);
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
    SimulationOptions options = moved_drive(Terrain::free, 645, 135);
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
    SimulationOptions options = moved_drive(seed % 2 ? Terrain::rough : Terrain::free, 1000 + seed);
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
  SimulationOptions options = moved_drive(Terrain::rough, 600);
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
  SimulationOptions options = moved_drive(Terrain::flat, 700, 200);
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
    SimulationOptions options = moved_drive(seed % 2 == 0 ? Terrain::rough : Terrain::free, seed, 12);
    options.faults[1].mount_changes = {bump(6, seed, 10)};
    const MovesResult result = moves_of(options);
    EXPECT_TRUE(result.tested);
    if (result.moves.size() == 1 && std::abs(result.moves[0].time - 6) < 1) ++found;
  }
  EXPECT_GE(found, 5u);
}

TEST(Moves, TheSameDriveGivesTheSameBits) {
  SimulationOptions options = moved_drive(Terrain::rough, 900);
  options.faults[1].mount_changes = {bump(60, 1, 2)};
  const MovesResult x = moves_of(options), y = moves_of(options);
  ASSERT_EQ(x.moves.size(), 1u);
  ASSERT_EQ(y.moves.size(), 1u);
  EXPECT_EQ(x.moves[0].false_alarm, y.moves[0].false_alarm);
  EXPECT_EQ(x.moves[0].change, y.moves[0].change);
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

TEST(Moves, SlowCreepIsCalledThat) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    SimulationOptions options = moved_drive(terrain, 500, 300);
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
    SimulationOptions options = moved_drive(terrain, 510, 1200);
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
    SimulationOptions options = moved_drive(terrain, 520, 1200);
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

}  // namespace
}  // namespace egocal::test_moves
