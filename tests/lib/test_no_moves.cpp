// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is not a moved mount is not called one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "../support/moved_drive.hpp"
#include "../support/paths.hpp"
#include "../support/real_drives.hpp"
#include "../support/standing.hpp"

namespace egocal::test_no_moves {
namespace {

using testing::bump;
using testing::moved_drive;
using testing::moves_of;

TEST(NoMoves, AStillMountRaisesNoAlarmWhateverTheNoise) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const Terrain terrain : {Terrain::rough, Terrain::free, Terrain::flat})
      for (int noise = 0; noise < 3; ++noise) {
        SimulationOptions options = moved_drive(terrain, 200 + seed);
        options.random_walk = noise == 1;
        options.heavy_tails = noise == 2;
        EXPECT_TRUE(moves_of(options).moves.empty()) << seed << " noise " << noise;
      }
}

TEST(NoMoves, NoiseThatGrowsWithEachMotionIsNone) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const Terrain terrain : {Terrain::rough, Terrain::flat}) {
      SimulationOptions options = moved_drive(terrain, 700 + seed, seed % 2 == 0 ? 60 : 200);
      options.speed = 5;
      options.speed_variation = 1;
      options.relative_noise = 0;
      options.noise_of_motion = 0.01;
      EXPECT_TRUE(moves_of(options).moves.empty()) << seed;
    }
}

TEST(NoMoves, AJumpOfOneOdometryIsNotAMovedMount) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SimulationOptions options = moved_drive(Terrain::rough, 300 + seed);
    options.faults[1].jumps = {{40.05, {rotation_exp({0, 0, 0.1}), {0.5, 0.2, 0}}},
                               {80.05, {rotation_exp({0.01, 0, 0}), {0, 0.1, 0}}}};
    EXPECT_TRUE(moves_of(options).moves.empty()) << seed;
  }
}

TEST(NoMoves, NoiseThatWandersForLongerThanABlockIsNone) {
  SimulationOptions options = moved_drive(Terrain::rough, 9343, 60);  // one of 1,500 that were tried
  options.random_walk = true;
  options.relative_noise = 0.03;
  const auto trajectories = simulate(options);
  MovesOptions short_blocks;
  short_blocks.most_correlation = INFINITY;
  EXPECT_EQ(moves_of(trajectories[0], trajectories[1], {}, short_blocks).moves.size(), 1u);
  EXPECT_TRUE(moves_of(trajectories[0], trajectories[1]).moves.empty());
}

/// A quarter of the drive at lights, where the odometry has other errors than on the way.
TEST(NoMoves, AVehicleThatStopsOftenHasNotMovedItsMount) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const double jitter : {0.0, 1e-3})
      for (const bool moved : {false, true}) {
        SimulationOptions options = moved_drive(terrain, 700);
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

// Neighbouring blocks are alike, and there are too few motions for longer ones. With the chance for blocks of
// eight motions, these of 400 such drives had a false alarm.
TEST(NoMoves, NoiseThatWandersIsNoneInAHundredMotions) {
  for (const std::uint64_t seed : {4u, 24u, 80u, 192u, 302u}) {
    SimulationOptions options = moved_drive(seed % 2 == 0 ? Terrain::rough : Terrain::free, seed, 12);
    options.random_walk = true;
    EXPECT_TRUE(moves_of(options).moves.empty()) << seed;
  }
}

TEST(NoMoves, TooShortADriveIsNotJudged) {
  SimulationOptions options = moved_drive(Terrain::rough, 800, 5);
  EXPECT_FALSE(moves_of(options).tested);
  EXPECT_FALSE(find_moves({}, {}).tested);
  // nothing moves at all
  const std::vector<MotionPair> still(1000);
  EXPECT_TRUE(find_moves(still, {}).moves.empty());
}

TEST(NoMoves, NoRealDriveRaisesAnAlarm) {
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

}  // namespace
}  // namespace egocal::test_no_moves
