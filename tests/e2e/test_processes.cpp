// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Odometry goes through the real processes and ends in the answer that the library gives offline.
#include "processes.hpp"

namespace egocal::test_processes {
namespace {

using namespace std::chrono_literals;
using test::bin;
using test::ChildProcess;
using test::drive;
using test::Event;
using test::events;
using test::Processes;

TEST_F(Processes, AtFullSpeedTheyGiveTheOfflineAnswerAndLoseNothing) {
  start("egocal-pairing");
  start("egocal-global", {"--always"});
  start("egocal-fast");
  const auto trajectories = drive(3000);
  const auto begin = std::chrono::steady_clock::now();
  play(events(trajectories));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  RecordProperty("pairs_per_second", std::to_string(2999 / took.count()));
  std::printf("%.0f motion pairs a second\n", 2999 / took.count());
  const Problem expected = offline(trajectories);
  ASSERT_TRUE(until([&] { return problem && problem->matched == 2999; }));
  expect_statistics(expected);
  ASSERT_TRUE(answered("egocal-fast"));
  ASSERT_TRUE(answered("egocal-global"));
  expect_answer("egocal-fast", expected);
  expect_answer("egocal-global", expected);
  EXPECT_EQ(counter("egocal-pairing", "lost"), 0);
}

TEST_F(Processes, LcmLogplayerReplaysALogOfBotCorePoses) {
  write_rig("bot_core.pose_t");
  const auto trajectories = drive(300);
  const std::string log = folder / "drive.log";
  {
    lcm::LogFile file(log, "w");
    ASSERT_TRUE(file.good());
    for (std::int64_t number = 0; const Event& event : events(trajectories)) {
      auto bytes = bus::encode(bus::to_pose_message(event.pose));
      lcm::LogEvent entry{number++, event.pose.time_us, channel(event.side),
                          static_cast<std::int32_t>(bytes.size()), bytes.data()};
      file.writeEvent(&entry);
    }
  }
  start("egocal-pairing");
  start("egocal-fast");
  start("egocal-global");
  ChildProcess logplayer({"lcm-logplayer", "--speed=10", "--lcm-url=" + url, log});
  const Problem expected = offline(trajectories);
  ASSERT_TRUE(until([&] { return problem && problem->matched == 299; }));
  EXPECT_EQ(logplayer.wait(patience), 0);
  expect_statistics(expected);
  ASSERT_TRUE(answered("egocal-fast"));
  expect_answer("egocal-fast", expected);
}

TEST_F(Processes, EgocalPlayerLosesNothingAtAnySpeed) {
  const auto trajectories = drive(1000);
  const Problem expected = offline(trajectories);
  const std::string log = folder / "drive.log";
  for (const std::string type : {"egocal.odometry_t", "bot_core.pose_t"}) {
    write_rig(type);
    bus::LogWriter writer(log);
    for (const Event& event : events(trajectories))
      writer.write(event.pose.time_us, channel(event.side),
                   type == "bot_core.pose_t" ? bus::encode(bus::to_pose_message(event.pose))
                                             : bus::encode(bus::to_message(event.pose, event.seq)));
    writer.close();
    for (const std::string speed : {"0", "1000", "50"}) {
      problem.reset();
      answers.clear();
      start("egocal-pairing");
      start("egocal-fast");
      start("egocal-global");
      ChildProcess replay({bin + "/egocal-player", log, "--lcm-url", url, "--speed", speed},
                          folder / "player.log");
      ASSERT_TRUE(until([&] { return problem && problem->matched == 999; })) << type << " at " << speed;
      EXPECT_EQ(replay.wait(patience), 0);
      expect_statistics(expected);
      ASSERT_TRUE(answered("egocal-fast"));
      expect_answer("egocal-fast", expected);
      EXPECT_EQ(counter("egocal-pairing", "lost"), 0);
    }
  }
}

TEST_F(Processes, EgocalPlayerSendsAgainWhatAKilledPairingMissed) {
  const auto trajectories = drive(2000);
  const std::string log = folder / "drive.log";
  bus::LogWriter writer(log);
  for (const Event& event : events(trajectories))
    writer.write(event.pose.time_us, channel(event.side),
                 bus::encode(bus::to_message(event.pose, event.seq)));
  writer.close();
  start("egocal-pairing");
  ChildProcess replay({bin + "/egocal-player", log, "--lcm-url", url, "--speed", "100"},
                      folder / "player.log");
  ASSERT_TRUE(until([&] { return problem && problem->matched > 300; }));
  processes.erase("egocal-pairing");  // SIGKILL
  problem.reset();
  until([] { return false; }, 700ms);
  start("egocal-pairing");
  ASSERT_TRUE(until([&] { return statuses["egocal-player"].state == "ended"; }));
  EXPECT_EQ(replay.wait(patience), 0);
  ASSERT_TRUE(problem.has_value());
  // The new process begins with what the old one had not acknowledged: one session, no hole. (Without a state
  // file its two streams may begin a few messages apart: what came before the player knew of it.)
  const std::int64_t first = problem->session;
  const auto begin = std::find_if(trajectories[0].begin(), trajectories[0].end(),
                                  [&](const StampedPose& pose) { return pose.time_us == first; });
  ASSERT_NE(begin, trajectories[0].end());
  const auto most = std::distance(begin, trajectories[0].end()) - 1;
  EXPECT_TRUE(until([&] { return problem->matched <= most && problem->matched > most - 32; }))
      << problem->matched << " of " << most;
  EXPECT_EQ(counter("egocal-pairing", "lost"), 0);
  EXPECT_GT(counter("egocal-player", "sent again"), 0);
}

TEST_F(Processes, AKilledPairingGoesOnFromItsStateFile) {
  const std::string state = folder / "pairing.state";
  start("egocal-pairing", {"--state", state});
  start("egocal-fast");
  const auto all = events(drive(600));
  play({all.begin(), all.begin() + 500});
  ASSERT_TRUE(until([&] { return problem && problem->matched == 249; }));
  const std::int64_t session = problem->session;
  problem.reset();
  start("egocal-pairing", {"--state", state});  // after SIGKILL
  // what was known is sent without any new measurement
  ASSERT_TRUE(until([&] { return problem && problem->matched == 249 && problem->session == session; }));
  EXPECT_EQ(counter("egocal-pairing", "restored"), 1);
  play({all.begin() + 500, all.end()});
  ASSERT_TRUE(until([&] { return problem->matched == 599; }));
  expect_statistics(offline(drive(600)));
}

TEST_F(Processes, AStateFileThatDoesNotFitIsRefusedWithOneLine) {
  const std::string state = folder / "pairing.state";
  const auto lines = [&](const std::string& name) {
    std::ifstream in(folder / name);
    std::vector<std::string> all;
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  };
  start("egocal-pairing", {"--state", state});
  // in use
  EXPECT_EQ(ChildProcess({bin + "/egocal-pairing", "--rig", rig_file, "--lcm-url", url, "--name", "other",
                          "--state", state},
                         folder / "in-use.log")
                .wait(patience),
            1);
  ASSERT_EQ(lines("in-use.log").size(), 1u);
  EXPECT_THAT(lines("in-use.log")[0], ::testing::HasSubstr("another process that is running"));
  processes.at("egocal-pairing").signal(SIGTERM);
  EXPECT_EQ(processes.at("egocal-pairing").wait(patience), 0);
  // of another rig
  write_rig("egocal.odometry_t", "[pairing]\nmax_gap = 0.7\n");
  start("egocal-pairing", {"--state", state}, "anew");
  EXPECT_TRUE(until([&] { return !statuses["anew"].last_error.empty(); }));
  EXPECT_THAT(statuses["anew"].last_error, ::testing::HasSubstr("another rig"));
  // the status is sent before the line is written
  ASSERT_TRUE(until([&] { return lines("anew.log").size() == 1u; }));
  EXPECT_THAT(lines("anew.log")[0], ::testing::HasSubstr("kept as " + state + ".refused"));
  // no state at all: a rig file
  EXPECT_EQ(ChildProcess({bin + "/egocal-pairing", "--rig", rig_file, "--lcm-url", url, "--state", rig_file},
                         folder / "not.log")
                .wait(patience),
            1);
  ASSERT_EQ(lines("not.log").size(), 1u);
  EXPECT_THAT(lines("not.log")[0], ::testing::HasSubstr("not a state of egocal-pairing"));
}

TEST_F(Processes, KilledAndSwappedSolversLeaveTheAnswerAsItWas) {
  start("egocal-pairing");
  start("egocal-global");
  start("egocal-fast");
  const auto trajectories = drive(900);
  const auto all = events(trajectories);
  const auto part = [&](std::size_t from, std::size_t to) {
    return std::vector<Event>(all.begin() + static_cast<std::ptrdiff_t>(from),
                              all.begin() + static_cast<std::ptrdiff_t>(to));
  };
  play(part(0, 600));
  processes.at("egocal-fast").signal(SIGKILL);
  processes.at("egocal-global").signal(SIGKILL);
  play(part(600, 900));
  answers.clear();
  // a fast solver of another kind, with no other change
  int asked = 0;
  loop->subscribe<problem_t>(bus::problem_channel("left", "right"),
                             [&](const problem_t&, const bus::Arrival&) { ++asked; });
  start("egocal-fast", {"--method", "slsqp"}, "another-fast");
  asked = 0;
  ASSERT_TRUE(until([&] { return answers.contains("another-fast") && answers["another-fast"].status == 0; }));
  EXPECT_LE(asked, 2) << "the problem is sent each second, and answered at once";
  play(part(900, all.size()));
  const Problem expected = offline(trajectories);
  ASSERT_TRUE(until([&] { return problem && problem->matched == 899; }));
  expect_statistics(expected);
  ASSERT_TRUE(answered("another-fast"));
  expect_answer("another-fast", expected, 1e-8);  // NLopt stops where the cost no longer changes
}

TEST_F(Processes, TheGlobalSolverStepsInWhenTheFastOneFallsSilent) {
  start("egocal-pairing");
  start("egocal-fast");
  start("egocal-global");
  const auto trajectories = drive(600);
  const auto all = events(trajectories);
  play({all.begin(), all.begin() + 600});
  EXPECT_TRUE(until([&] { return statuses["egocal-global"].state == "standby"; }));
  processes.at("egocal-fast").signal(SIGKILL);
  answers.clear();
  play({all.begin() + 600, all.end()});
  ASSERT_TRUE(until([&] { return problem && problem->matched == 599; }));
  ASSERT_TRUE(answered("egocal-global"));
  expect_answer("egocal-global", offline(trajectories));
  EXPECT_TRUE(until([&] { return statuses["egocal-global"].state == "running"; }));
}

TEST_F(Processes, TheFastSolverGoesOnWithoutTheGlobalOneAndSaysSo) {
  start("egocal-pairing");
  start("egocal-fast");
  const auto trajectories = drive(300);
  play(events(trajectories));
  ASSERT_TRUE(until([&] { return problem && problem->matched == 299; }));
  ASSERT_TRUE(answered("egocal-fast"));
  expect_answer("egocal-fast", offline(trajectories));
  EXPECT_TRUE(until(
      [&] { return statuses["egocal-fast"].last_error.find("no global solver") != std::string::npos; }));
}

TEST_F(Processes, DamagedMessagesAreCountedAndHarmNothing) {
  start("egocal-pairing");
  start("egocal-fast");
  const auto trajectories = drive(300);
  const auto all = events(trajectories);
  play({all.begin(), all.begin() + 300});
  const std::int64_t before = acknowledged();
  auto bytes = bus::encode(bus::to_message(all[300].pose, all[300].seq));
  auto wrong_type = bytes;
  wrong_type[0] ^= std::byte{0x40};
  loop->publish_bytes("ODO_LEFT", wrong_type);
  loop->publish_bytes("ODO_LEFT", bus::Bytes(bytes).first(bytes.size() - 5));
  loop->publish_bytes("ODO_LEFT", bus::Bytes(bytes).first(3));
  odometry_t not_finite = bus::to_message(all[300].pose, all[300].seq);
  not_finite.pos[1] = std::nan("");
  loop->publish("ODO_LEFT", not_finite);
  odometry_t far_future = bus::to_message(all[300].pose, all[300].seq);
  far_future.utime += std::int64_t{1} << 45;
  loop->publish("ODO_LEFT", far_future);
  loop->publish_bytes(bus::problem_channel("left", "right"), bytes);
  loop->publish_bytes(bus::status_channel, bytes);
  loop->publish_bytes(bus::command_channel, bytes);
  ASSERT_TRUE(until([&] { return acknowledged() - before == 5; }));
  play({all.begin() + 300, all.end()});
  ASSERT_TRUE(until([&] { return problem && problem->matched == 299; }));
  expect_statistics(offline(trajectories));
  ASSERT_TRUE(answered("egocal-fast"));
  expect_answer("egocal-fast", offline(trajectories));
  EXPECT_EQ(counter("egocal-pairing", "rejected: not decodable on ODO_LEFT"), 3);
  EXPECT_EQ(counter("egocal-pairing", "rejected: position not finite"), 1);
  EXPECT_EQ(counter("egocal-pairing", "rejected: time or number jumps"), 1);
  ASSERT_TRUE(until([&] {
    return counter("egocal-fast", "rejected: not decodable on " + bus::problem_channel("left", "right")) == 1;
  }));
}

TEST_F(Processes, ALogThatBeginsAgainBeginsANewSession) {
  start("egocal-pairing");
  start("egocal-fast");
  const auto trajectories = drive(200);
  play(events(trajectories));
  ASSERT_TRUE(until([&] { return problem && problem->matched == 199; }));
  const std::int64_t first = problem->session;
  play(events(trajectories));
  ASSERT_TRUE(until([&] { return problem->session > first && problem->matched == 199; }));
  expect_statistics(offline(trajectories));
}

TEST_F(Processes, CommandsResetPauseAndResume) {
  start("egocal-pairing");
  const auto trajectories = drive(300);
  const auto all = events(trajectories);
  play({all.begin(), all.begin() + 300});
  ASSERT_TRUE(until([&] { return problem && problem->matched == 149; }));
  const std::int64_t first = problem->session;
  command_t command{};
  command.to = "*";
  command.verb = "reset";
  command.session = first + 1;
  loop->publish(bus::command_channel, command);
  ASSERT_TRUE(
      until([&] { return counter("egocal-pairing", "rejected: command for another session or pair") == 1; }));
  command.session = first;
  loop->publish(bus::command_channel, command);
  ASSERT_TRUE(until([&] { return counter("egocal-pairing", "commands") == 1; }));
  play({all.begin() + 300, all.end()});
  ASSERT_TRUE(until([&] { return problem->session == all[300].pose.time_us && problem->matched == 149; }));
  command.verb = "pause";
  command.session = 0;
  loop->publish(bus::command_channel, command);
  ASSERT_TRUE(until([&] { return statuses["egocal-pairing"].state == "paused"; }));
  command.verb = "resume";
  loop->publish(bus::command_channel, command);
  ASSERT_TRUE(until([&] { return statuses["egocal-pairing"].state == "running"; }));
}

TEST_F(Processes, ASecondPairingOfTheSameNameWaitsAndTakesOver) {
  start("egocal-pairing");
  start("egocal-fast");
  processes.emplace("second", ChildProcess({bin + "/egocal-pairing", "--rig", rig_file, "--lcm-url", url},
                                           folder / "second.log"));
  // a pairing that starts is waiting, too, for a moment: the reason distinguishes them
  ASSERT_TRUE(until([&] {
    const status_t& status = statuses["egocal-pairing"];
    return status.state == "waiting" &&
           status.last_error.find("another process has this name") != std::string::npos;
  }));
  processes.at("egocal-pairing").signal(SIGTERM);
  EXPECT_EQ(processes.at("egocal-pairing").wait(patience), 0);
  ASSERT_TRUE(until([&] { return statuses["egocal-pairing"].state == "running"; }));
}

TEST_F(Processes, TheyEndCleanlyAndSayWhatIsWrong) {
  for (const std::string program : {"egocal-pairing", "egocal-fast", "egocal-global"}) {
    for (const int number : {SIGINT, SIGTERM}) {
      start(program);
      processes.at(program).signal(number);
      EXPECT_EQ(processes.at(program).wait(patience), 0) << program;
      ASSERT_TRUE(until([&] { return statuses[program].state == "ended"; }));
    }
    const std::string output = folder / "output";
    EXPECT_EQ(ChildProcess({bin + "/" + program, "--help"}).wait(patience), 0);
    EXPECT_EQ(ChildProcess({bin + "/" + program, "--version"}).wait(patience), 0);
    EXPECT_EQ(ChildProcess({bin + "/" + program}).wait(patience), 2);
    EXPECT_EQ(ChildProcess({bin + "/" + program, "--rig", rig_file, "--rgi", "x"}).wait(patience), 2);
    EXPECT_EQ(ChildProcess({bin + "/" + program, "--rig", "/nonexistent"}, output).wait(patience), 1);
    EXPECT_EQ(ChildProcess({bin + "/" + program, "--rig", rig_file, "--lcm-url", "udpm://nowhere:1"}, output)
                  .wait(patience),
              1);
    std::ifstream in(output);
    std::string line;
    int lines = 0;
    while (std::getline(in, line)) ++lines;
    EXPECT_EQ(lines, 2) << "one clear line each";
    std::filesystem::remove(output);
  }
}

/// Two processes that only hand a message on, as pairing and a solver hand a pose on: the peer of an answer.
class RelayedMessage {
 public:
  static constexpr const char* channel = "PEER";

  RelayedMessage(const std::string& from, const std::filesystem::path& folder) {
    const std::string program =
        std::filesystem::read_symlink("/proc/self/exe").parent_path() / "egocal_lossy_relay";
    const std::string between = "udpm://239.255.76.67:7798?ttl=0", to = "udpm://239.255.76.67:7799?ttl=0";
    for (const auto& [in, out] : {std::pair(from, between), std::pair(between, to)})
      relays_.emplace_back(
          std::vector<std::string>{program, "--from", in, "--to", out, "--channel", channel, "--drop", "0",
                                   "--double", "0", "--reorder", "0", "--flip", "0"},
          folder / "relay.log");
    loop_ = std::make_unique<bus::Loop>(to, bus::LoopOptions{.handle_signals = false});
    loop_->subscribe_bytes(channel, [this](const bus::Arrival& arrival) { arrived_us_ = arrival.mono_us; });
  }

  /// From sending to arrival [us]; none: it did not arrive within the time.
  std::optional<std::int64_t> send(bus::Loop& sender, bus::Bytes bytes, std::chrono::milliseconds within) {
    arrived_us_.reset();
    const std::int64_t sent_us = loop_->mono_us();
    sender.publish_bytes(channel, bytes);
    while (!arrived_us_ && loop_->mono_us() < sent_us + within / 1us) loop_->run_once(1ms);
    if (!arrived_us_) return std::nullopt;
    return *arrived_us_ - sent_us;
  }

 private:
  std::vector<ChildProcess> relays_;
  std::unique_ptr<bus::Loop> loop_;
  std::optional<std::int64_t> arrived_us_;
};

// Wall time on a machine that does other things says nothing. Two relays run beside, in turns with the poses,
// and the fastest quarter of both is compared: these waited for no other program. docs/benchmarks.md has the
// times of an idle machine.
TEST_F(Processes, AnAnswerTakesAFewTimesAsLongAsARelayedMessage) {
  start("egocal-pairing");
  start("egocal-fast");
  start("egocal-global");
  RelayedMessage peer(url, folder);
  ASSERT_TRUE(until([&] { return peer.send(*loop, {}, 100ms).has_value(); })) << "the relays do not start";

  std::vector<std::int64_t> answered_us, relayed_us;
  std::optional<std::int64_t> arrived_us;
  std::int64_t newest = 0;
  loop->subscribe_bytes(bus::calibration_channel("left", "right"), [&](const bus::Arrival& arrival) {
    calibration_t answer{};
    if (bus::decode(arrival.bytes, answer) && answer.solver == "egocal-fast" && answer.status == 0 &&
        answer.pairs > newest) {
      newest = answer.pairs;
      arrived_us = arrival.mono_us;
    }
  });
  for (const Event& event : events(drive(400))) {
    const std::vector<std::byte> bytes = bus::encode(bus::to_message(event.pose, event.seq));
    if (const auto relayed = peer.send(*loop, bytes, 200ms)) relayed_us.push_back(*relayed);
    arrived_us.reset();
    const std::int64_t sent_us = loop->mono_us();
    loop->publish_bytes(channel(event.side), bytes);
    // a pair of motions ends with a pose of the second sensor
    const auto end = std::chrono::steady_clock::now() + (event.side == Side::b ? 50ms : 1ms);
    while (!arrived_us && std::chrono::steady_clock::now() < end) loop->run_once(1ms);
    if (arrived_us) answered_us.push_back(*arrived_us - sent_us);
  }
  ASSERT_GT(answered_us.size(), 300u);
  ASSERT_GT(relayed_us.size(), 700u);
  const auto quantile = [](std::vector<std::int64_t>& values, std::size_t percent) {
    std::sort(values.begin(), values.end());
    return values[values.size() * percent / 100];
  };
  for (const std::size_t percent : {25u, 50u, 90u, 99u})
    std::printf("p%zu: an answer %ld us, two relays %ld us\n", percent,
                static_cast<long>(quantile(answered_us, percent)),
                static_cast<long>(quantile(relayed_us, percent)));
  EXPECT_LT(quantile(answered_us, 25), 10 * quantile(relayed_us, 25)) << "2 to 7 times is usual";
}

}  // namespace
}  // namespace egocal::test_processes
