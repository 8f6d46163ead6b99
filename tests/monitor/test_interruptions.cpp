// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What a user asked for, and a network that is away, are no faults of others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "egocal/monitor/lines.hpp"
#include "egocal/monitor/model.hpp"
#include "egocal/monitor/view.hpp"
#include "pair_drive.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_interruptions {
namespace {

using test::begin_utime;
using test::PairDrive;
using test::status_of;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Interrupted : public ::testing::Test {
 protected:
  Interrupted() {
    count(player, "seeks", 0);
    drive.heartbeat(player);
    drive.heartbeat(pairing);
    drive.run(30);
    heartbeats();
    drive.fresh();
    alarms();
  }
  static void count(status_t& status, const std::string& name, std::int64_t value) {
    for (counter_t& counter : status.counters)
      if (counter.name == name) {
        counter.value = value;
        return;
      }
    status.counters.emplace_back().name = name;
    status.counters.back().value = value;
    status.n_counters = static_cast<std::int32_t>(status.counters.size());
  }
  void heartbeats() {
    for (const status_t* status : {&player, &pairing, &diagnosis}) drive.heartbeat(*status);
  }
  void command(const std::string& verb, const std::string& to, bool pair) {
    command_t message{};
    message.verb = verb;
    message.to = to;
    if (pair) {
      message.sensor_a = "lidar";
      message.sensor_b = "camera";
    }
    drive.model.on_command(message, drive.now());
  }
  /// The problems repeat the newest motion for so many tenths of a second, and heartbeats come.
  void stand(int steps) {
    const problem_t newest = drive.pair().problem;
    drive.change_problem = [newest](problem_t& p) { p = newest; };
    drive.fast = pairing.state != "paused";
    for (int i = 0; i < steps; ++i) {
      if (i % 10 == 0) heartbeats();
      drive.run(1);
    }
    drive.fast = true;
    drive.change_problem = [](problem_t&) {};
  }
  /// The motions go on. So many numbers have not been given meanwhile, and so much of the log is skipped [s].
  void go_on(int missing, std::int64_t skipped) {
    drive.change_problem = [=](problem_t& p) {
      p.seq -= missing;
      p.utime += (skipped - missing / 10) * 1'000'000;
    };
    for (int i = 0; i < 3; ++i) {
      drive.run(5);
      heartbeats();
    }
  }
  /// Events since the last call that are no good news.
  std::vector<std::string> alarms() {
    std::vector<std::string> texts;
    const auto& events = drive.model.events();
    for (std::size_t i = seen; i < events.size(); ++i)
      if (events[i].severity >= Severity::warning) texts.push_back(events[i].subject + ": " + events[i].text);
    seen = events.size();
    return texts;
  }
  const ProcessState& process(const std::string& name) const {
    for (const ProcessState& one : drive.model.processes())
      if (one.status.name == name) return one;
    throw std::runtime_error(name + " was not heard");
  }

  PairDrive drive;
  status_t player = status_of("egocal-player", "player", 1),
           pairing = status_of("egocal-pairing", "pairing", 1),
           diagnosis = status_of("egocal-diagnosis", "diagnosis", 1);
  std::size_t seen = 0;
};

}  // namespace

TEST_F(Interrupted, APauseIsNoGapAndWhatItRejectsIsNoFault) {
  command("pause", "*", true);
  pairing.state = diagnosis.state = "paused";
  stand(250);
  command("resume", "*", true);
  pairing.state = diagnosis.state = "running";
  drive.model.set_why_standing(0, "pairing rejects the poses");
  stand(2);
  count(pairing, "rejected: gap", 4);
  heartbeats();
  go_on(252, 25);
  EXPECT_THAT(alarms(), IsEmpty());
  const std::vector<std::string> texts = drive.fresh();
  EXPECT_THAT(texts, Contains("lidar -> camera: paused for 25.3 s of the drive"));
  EXPECT_THAT(texts, Not(Contains(HasSubstr("rejects"))));
  EXPECT_EQ(drive.pair().gap_count, 0);
  EXPECT_EQ(process("egocal-pairing").rejected, 0);

  // later ones are
  drive.run(80);
  count(pairing, "rejected: gap", 7);
  heartbeats();
  EXPECT_EQ(process("egocal-pairing").rejected, 3);
  EXPECT_THAT(drive.fresh(), Contains(HasSubstr("egocal-pairing: rejects: gap")));
  drive.change_problem = [](problem_t& p) { p.seq -= 264; };
  drive.step += 12;
  drive.run(1);
  EXPECT_THAT(drive.fresh(), Contains("lidar -> camera: gap of 1.3 s in the stream"));
}

TEST_F(Interrupted, WhatProcessesMissOfEachOtherWhenTheyResumeIsNoNews) {
  status_t fast = status_of("egocal-fast", "fast", 1);
  fast.state = "paused";
  drive.heartbeat(fast);
  fast.state = "running";
  fast.last_error = "no global solver is alive: global solutions are computed here as well";
  drive.heartbeat(fast);
  fast.last_error = "";
  drive.heartbeat(fast);
  EXPECT_THAT(alarms(), IsEmpty());
  drive.run(10);
  fast.last_error = "no global solver is alive: global solutions are computed here as well";
  drive.heartbeat(fast);
  EXPECT_THAT(alarms(), IsEmpty());
  for (int i = 0; i < 3; ++i) {
    heartbeats();
    drive.run(10);
    drive.heartbeat(fast);
  }
  EXPECT_THAT(alarms(), ElementsAre("egocal-fast: " + fast.last_error)) << "it lasts";
}

TEST_F(Interrupted, ASeekForwardsIsNoLoss) {
  count(player, "seeks", 1);
  heartbeats();
  drive.run(2);  // was on its way
  count(pairing, "lost", 2674);
  go_on(0, 134);
  EXPECT_THAT(alarms(), IsEmpty());
  EXPECT_THAT(drive.fresh(),
              Contains("lidar -> camera: skipped 134.1 s of the drive, by a seek of the player"));
  EXPECT_EQ(process("egocal-pairing").lost, 0);
  drive.run(60);
  count(pairing, "lost", 2680);
  heartbeats();
  EXPECT_EQ(process("egocal-pairing").lost, 6);
}

// What was counted before cannot be told from what the seek cost.
TEST_F(Interrupted, AMonitorThatComesAfterASeekShowsNothingOfItAsLost) {
  const auto heard = [](const PairDrive& late) {
    for (const ProcessState& one : late.model.processes())
      if (one.status.name == "egocal-pairing") return one;
    throw std::runtime_error("pairing was not heard");
  };
  for (const bool player_first : {true, false}) {
    count(player, "seeks", 1);
    count(pairing, "lost", 1600);
    count(pairing, "rejected: gap", 2);
    PairDrive late;
    if (player_first) late.heartbeat(player);
    late.heartbeat(pairing);
    if (!player_first) late.heartbeat(player);
    EXPECT_EQ(heard(late).lost, 0) << player_first;
    EXPECT_EQ(heard(late).rejected, 0) << player_first;
    EXPECT_THAT(heard(late).rejections, IsEmpty()) << player_first;
    late.run(60);
    count(pairing, "lost", 1603);
    late.heartbeat(pairing);
    EXPECT_EQ(heard(late).lost, 3) << player_first;
    EXPECT_EQ(heard(late).rejected, 0) << player_first;
  }
  count(player, "seeks", 0);
  PairDrive without_a_seek;
  without_a_seek.heartbeat(player);
  without_a_seek.heartbeat(pairing);
  EXPECT_EQ(heard(without_a_seek).lost, 1603);
}

// As pairing sends it: the motion across the seek is rejected.
TEST_F(Interrupted, ASeekIsSeenInAProblemWithoutANewMotion) {
  count(player, "seeks", 1);
  heartbeats();
  drive.change_problem = [](problem_t& p) {
    p.seq -= 1;
    p.utime += 51'000'000;
  };
  drive.run(10);
  EXPECT_THAT(alarms(), IsEmpty());
  EXPECT_THAT(drive.fresh(),
              Contains("lidar -> camera: skipped 51.1 s of the drive, by a seek of the player").Times(1));
}

TEST_F(Interrupted, TheEndOfAllProcessesIsNoLackOfAVerdict) {
  Diagnosis judged;
  judged.verdict = Verdict::good;
  judged.reason = "The motions agree.";
  const verdict_t message = test::verdict_at(judged, drive.pair().problem.utime, begin_utime, 28);
  drive.model.on_verdict(message, *bus::to_verdict(message).value, drive.now());
  drive.run(1);
  pairing.state = diagnosis.state = player.state = "ended";
  heartbeats();
  drive.model.tick(drive.now());
  EXPECT_THAT(alarms(), IsEmpty());
}

TEST_F(Interrupted, ASeekOfAPausedPlayerIsSeenWhenItGoesOn) {
  player.state = "paused";
  count(player, "seeks", 1);
  stand(300);
  player.state = "running";
  heartbeats();
  count(pairing, "lost", 2000);
  go_on(300, 100);
  EXPECT_THAT(alarms(), IsEmpty());
  EXPECT_EQ(process("egocal-pairing").lost, 0);
}

TEST_F(Interrupted, ASeekBackwardsStartsAgainWithoutAnAlarm) {
  count(player, "seeks", 1);
  heartbeats();
  count(pairing, "rejected: duplicate", 8);
  count(diagnosis, "rejected: duplicate", 4);
  heartbeats();
  drive.change_problem = [](problem_t& p) {
    p.session = begin_utime + 1'000'000;
    p.utime -= 2'000'000;
    p.seq = 1;
  };
  drive.run(1);
  EXPECT_THAT(alarms(), IsEmpty());
  EXPECT_THAT(drive.fresh(), Contains("lidar -> camera: the player went back: the calibration starts again"));
  EXPECT_EQ(process("egocal-pairing").rejected, 0);
}

TEST_F(Interrupted, AResetThatWasAskedForIsNoAlarm) {
  command("reset", "*", true);
  drive.change_problem = [](problem_t& p) { p.session = begin_utime + 3'000'000; };
  drive.run(1);
  EXPECT_THAT(alarms(), IsEmpty());
  EXPECT_THAT(drive.fresh(),
              Contains("lidar -> camera: session reset, as asked for: the calibration starts again"));
  drive.change_problem = [](problem_t& p) { p.session = begin_utime + 3'100'000; };
  drive.run(1);
  EXPECT_THAT(alarms(), ElementsAre("lidar -> camera: session reset: the calibration starts again"));
}

TEST_F(Interrupted, InAPauseNoVerdictAndNoAnswerIsMissed) {
  Diagnosis judged;
  judged.verdict = Verdict::good;
  judged.reason = "The motions agree.";
  const verdict_t message = test::verdict_at(judged, drive.pair().problem.utime, begin_utime, 28);
  const bus::Checked<bus::ReceivedVerdict> received = bus::to_verdict(message);
  ASSERT_TRUE(received) << received.reason;
  drive.model.on_verdict(message, *received.value, drive.now());
  drive.fast = false;  // the newest problem is neither judged nor answered
  drive.run(1);
  command("pause", "*", true);
  pairing.state = "paused";
  stand(300);
  EXPECT_THAT(alarms(), IsEmpty());
  EXPECT_EQ(drive.pair().verdict->old, 0);
  EXPECT_EQ(drive.pair().old, 0);
}

TEST_F(Interrupted, WithoutANetworkNobodyElseIsToBlame) {
  ModelOptions options;
  options.own_host = "car";
  options.own_pid = 7;
  drive.step = 0;
  drive.seen = 0;
  drive.model = Model(options);
  status_t own = status_of("egocal-monitor", "monitor", 1);
  own.pid = 7;
  drive.heartbeat(own);
  heartbeats();
  drive.run(30);
  Diagnosis judged;
  judged.verdict = Verdict::good;
  judged.reason = "The motions agree.";
  const verdict_t message = test::verdict_at(judged, drive.pair().problem.utime, begin_utime, 30);
  drive.model.on_verdict(message, *bus::to_verdict(message).value, drive.now());
  drive.run(1);
  drive.fresh();
  seen = drive.model.events().size();

  drive.step += 10;
  drive.model.set_network("no multicast: away", drive.now());
  for (int i = 0; i < 300; ++i, ++drive.step) drive.model.tick(drive.now());
  EXPECT_THAT(drive.fresh(), ElementsAre("network: no multicast: away"));
  ViewState view;
  view.network_error = "no multicast: away";
  Canvas canvas(110, 30);
  draw(canvas, drive.model, view);
  const std::string screen = canvas.to_text();
  for (const char* part :
       {"NO NETWORK", "unknown", "? old answer", "no network, nothing received for 31 s", "0 of 1 good"})
    EXPECT_THAT(screen, HasSubstr(part));
  for (const char* part : {"GONE", " gone", "SILENT", "egocal-diagnosis running?"})
    EXPECT_THAT(screen, Not(HasSubstr(part)));
  EXPECT_THAT(text_lines(drive.model, Charset::ascii), HasSubstr("egocal-pairing: unknown (no network)"));
  EXPECT_TRUE(nlohmann::json::parse(json_line(drive.model))["processes"][1]["alive"].is_null());

  // who is not heard when it is back is gone
  drive.model.set_network("", drive.now());
  drive.heartbeat(pairing);
  drive.run(25);
  EXPECT_THAT(drive.fresh(), ElementsAre("network: the network is back"));
  drive.run(10);
  EXPECT_THAT(drive.fresh(), Contains("egocal-player: process is gone: no heartbeat for 3 s"));
}

TEST(HeardOthers, TheOwnHeartbeatDoesNotCount) {
  ModelOptions options;
  options.own_host = "car";
  options.own_pid = 7;
  Model model(options);
  model.expect_pair("lidar", "camera");
  status_t own = status_of("egocal-monitor", "monitor", 1);
  own.pid = 7;
  model.on_status(own, {1'000'000, begin_utime});
  EXPECT_FALSE(model.heard_others());
  model.on_status(status_of("egocal-fast", "fast", 1), {1'000'000, begin_utime});
  EXPECT_TRUE(model.heard_others());
}

}  // namespace egocal::monitor::test_interruptions
