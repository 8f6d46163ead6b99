// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Problems in, plain data out: motions that come, fail to come, or are paused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "egocal/monitor/model.hpp"
#include "egocal/monitor/view.hpp"
#include "pair_drive.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_model_motions {
namespace {

using test::PairDrive;
using test::status_of;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ModelEvents, ManyMotionsThatContradictTheOthers) {
  PairDrive drive;
  drive.change_problem = [](problem_t& p) { p.left_out = p.matched / 30; };
  drive.run(100);
  EXPECT_THAT(drive.texts(), Not(Contains(HasSubstr("contradict"))));
  drive.fresh();
  drive.change_problem = [](problem_t& p) {
    p.matched = 90;
    p.left_out = 10;
  };
  drive.run(50);
  EXPECT_THAT(
      drive.fresh(),
      ElementsAre("lidar -> camera: 10 % of the motions contradict the others and are rejected as outliers"));
  drive.change_problem = [](problem_t& p) { p.left_out = p.matched = 100; };
  drive.run(50);
  EXPECT_THAT(
      drive.fresh(),
      ElementsAre("lidar -> camera: 50 % of the motions contradict the others and are rejected as outliers"));
}

TEST(ModelEvents, GapInAStreamAndSilence) {
  PairDrive drive;
  drive.run(30);
  drive.fresh();
  drive.step += 12;  // twelve problems were skipped, as under a flood: their motions are in the next one
  drive.run(1);
  EXPECT_THAT(drive.fresh(), ElementsAre());
  EXPECT_EQ(drive.pair().gap_count, 0);
  drive.step += 12;  // 1.2 s are missing, and no motion is in them
  drive.change_problem = [](problem_t& p) { p.seq -= 12; };
  drive.run(1);
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: gap of 1.3 s in the stream"));
  EXPECT_EQ(drive.pair().gap_count, 1);
  // as many steps as one motion spans are no gap
  drive.change_problem = [](problem_t& p) {
    p.stride = 4;
    p.seq -= 27;
  };
  drive.step += 15;
  drive.run(1);
  EXPECT_EQ(drive.pair().gap_count, 1);
  drive.fresh();
  drive.step += 21;
  drive.model.tick(drive.now());
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: the stream is silent: no new motion for 2 s"));
  drive.run(1);
  EXPECT_THAT(drive.fresh(), Contains("lidar -> camera: the stream is back"));
}

TEST(ModelEvents, NoNewMotionThoughPairingLives) {
  PairDrive drive;
  drive.run(30);
  drive.fresh();
  const std::int64_t newest = drive.pair().problem.seq;
  drive.change_problem = [&](problem_t& p) { p.seq = newest; };  // sent again and again
  drive.run(60);
  EXPECT_NEAR(drive.pair().standing, 6, 0.2);
  EXPECT_THAT(drive.fresh(), ElementsAre()) << "a log has ended, or nothing is known of the streams";
  drive.model.set_why_standing(0, "camera sends nothing");
  drive.run(1);
  EXPECT_THAT(drive.fresh(), ElementsAre("lidar -> camera: no new motion for 6 s: camera sends nothing"));
  drive.run(20);
  EXPECT_THAT(drive.fresh(), ElementsAre());
  drive.change_problem = [](problem_t&) {};
  drive.run(1);
  EXPECT_EQ(drive.pair().standing, 0);
  EXPECT_THAT(drive.fresh(), Contains("lidar -> camera: new motions come again"));
}

TEST(ModelPause, KnownByCommandsByStatesAndByMotionsThatGoOn) {
  PairDrive drive;
  drive.run(5);
  EXPECT_FALSE(pair_is_paused(drive.model, drive.pair()));
  command_t command{};
  command.to = "*";
  command.verb = "pause";
  command.sensor_a = "lidar";
  command.sensor_b = "other";
  drive.model.on_command(command, drive.now());
  EXPECT_FALSE(pair_is_paused(drive.model, drive.pair())) << "that was another pair";
  command.sensor_b = "camera";
  command.to = "egocal-player";
  drive.model.on_command(command, drive.now());
  status_t player = status_of("egocal-player", "player", 1);
  player.state = "paused";
  drive.heartbeat(player);
  EXPECT_FALSE(pair_is_paused(drive.model, drive.pair())) << "the player rests, the calibration does not";
  command.to = "*";
  drive.model.on_command(command, drive.now());
  // problems are repeated while paused, without new motions and without answers
  drive.change_problem = [](problem_t& p) { p.seq = 5; };
  drive.fast = false;
  drive.run(40);
  EXPECT_TRUE(pair_is_paused(drive.model, drive.pair()));
  EXPECT_THAT(drive.texts(), Not(Contains(HasSubstr("no longer answers"))));
  drive.fast = true;
  drive.change_problem = [](problem_t&) {};
  drive.run(1);
  EXPECT_FALSE(pair_is_paused(drive.model, drive.pair())) << "it was resumed by a message that was lost";
  status_t status = status_of("egocal-pairing", "pairing", 1);
  status.state = "paused";
  drive.heartbeat(status);
  EXPECT_TRUE(pair_is_paused(drive.model, drive.pair()));

  ViewState view;
  press(view, drive.model, {Key::character, 'p'});
  EXPECT_EQ(view.dialog, Dialog::resume);
  EXPECT_EQ(press(view, drive.model, {Key::character, 'y'}).kind, Action::Kind::resume);
}

}  // namespace
}  // namespace egocal::monitor::test_model_motions
