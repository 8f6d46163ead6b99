// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What `egocal up` says of a drive that it played.
#include "egocal/bus/channels.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "json_keys.hpp"
#include "up.hpp"

namespace egocal::test_up {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;
using test::read;
using test::send_signal;
using test::until;
using test::Up;
using ::testing::HasSubstr;

TEST_F(Up, PlaysALogToItsEndAndEndsAll) {
  ChildProcess egocal = up({"--log", log, "--speed", "0", "--follow", "--report"});
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  const std::string page = read(path("out/report-lidar-camera.html"));
  EXPECT_THAT(page, HasSubstr("good: "));
  EXPECT_THAT(page, HasSubstr("</html>"));
  EXPECT_THAT(read(path("said")), HasSubstr("report-lidar-camera.html: good: "));
  for (const char* name :
       {"egocal-pairing", "egocal-fast", "egocal-global", "egocal-diagnosis", "egocal-player"})
    EXPECT_TRUE(std::filesystem::exists(path("out/" + std::string(name) + ".out"))) << name;
  EXPECT_THAT(read(path("said")), HasSubstr("optimal (proven)"));
}

TEST_F(Up, AnAnswerThatShouldNotBeUsedEndsWithThree) {
  ASSERT_EQ(ChildProcess({paths::bin_dir() + "/egocal", "simulate", "--out", log, "--rig-out", rig, "--poses",
                          "400", "--noise", "0.001", "--terrain", "free", "--scale", "camera=2.7"})
                .wait(60s),
            0);
  ChildProcess egocal = up({"--log", log, "--speed", "20"});
  EXPECT_EQ(egocal.wait(60s), 3) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> camera: contradictory: "));
  EXPECT_THAT(read(path("said")), HasSubstr("Cure: "));
  EXPECT_THAT(read(path("said")), HasSubstr("optimal (proven), "));
}

// The diagnosis takes a small share of a core: at the end of a log most of these pairs have not been judged,
// or by the part of the drive before the mount moved.
TEST_F(Up, WaitsUntilEveryPairOfALargeRigIsJudged) {
  std::vector<std::string> simulate{paths::bin_dir() + "/egocal",
                                    "simulate",
                                    "--out",
                                    log,
                                    "--rig-out",
                                    rig,
                                    "--poses",
                                    "800",
                                    "--noise",
                                    "0.005",
                                    "--terrain",
                                    "free",
                                    "--bump",
                                    "s6=50:0,0.05,0,0,4,0"};
  for (int i = 1; i <= 6; ++i) {
    simulate.push_back("--sensor");
    simulate.push_back("s" + std::to_string(i) + "=" + std::to_string(0.3 * i) + ",0,1,1,0,0,0");
  }
  ASSERT_EQ(ChildProcess(simulate).wait(60s), 0);
  std::string text = read(rig);
  text.resize(text.find("[[pair]]"));
  for (int a = 1; a <= 6; ++a)
    for (int b = a + 1; b <= 6; ++b)
      text += "[[pair]]\na = \"s" + std::to_string(a) + "\"\nb = \"s" + std::to_string(b) + "\"\n";
  std::ofstream(rig) << text;
  ChildProcess egocal = up({"--log", log, "--speed", "0"});
  EXPECT_EQ(egocal.wait(200s), 3) << read(path("said"));
  const std::string said = read(path("said"));
  for (int a = 1; a <= 6; ++a)
    for (int b = a + 1; b <= 6; ++b)
      EXPECT_THAT(said, HasSubstr("s" + std::to_string(a) + " -> s" + std::to_string(b) +
                                  (b == 6 ? ": contradictory: " : ": good: ")));
}

// It ended at once, as if nothing was awaited, and then waited for ever for what was calibrated.
TEST_F(Up, WaitsForAListeningProcessThatWasStopped) {
  ChildProcess egocal = up({"--log", log, "--speed", "20"});
  ASSERT_TRUE(until([&] { return all_run(egocal.pid(), {"egocal", "egocal-player"}); }));
  std::this_thread::sleep_for(500ms);
  send_signal(child(egocal.pid(), "egocal"), SIGSTOP);
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> camera: good: "));
  EXPECT_THAT(read(path("said")), HasSubstr(", 400 motion pairs; "));
}

// It was given up after five seconds, in which the one that had stopped was not continued yet.
TEST_F(Up, WaitsForTheVerdictOfADiagnosisThatIsStoppedAgainAndAgain) {
  ChildProcess egocal = up({"--log", log, "--speed", "20"});
  ASSERT_TRUE(until([&] { return all_run(egocal.pid(), {"egocal-diagnosis", "egocal-player"}); }));
  const pid_t first = child(egocal.pid(), "egocal-diagnosi");
  std::this_thread::sleep_for(1s);
  std::thread stopper([&] {
    while (test::runs(first) && child(egocal.pid(), "egocal-diagnosi") == first) {
      send_signal(first, SIGSTOP);
      std::this_thread::sleep_for(20ms);
    }
  });
  EXPECT_EQ(egocal.wait(90s), 0) << read(path("said"));
  stopper.join();
  const std::string said = read(path("said"));
  EXPECT_THAT(said, HasSubstr("egocal-diagnosis still hangs and is killed"));
  // by what its successor knows: poses that were not saved are not judged again, and that is said
  EXPECT_THAT(said, HasSubstr("lidar -> camera: "));
  EXPECT_THAT(said, ::testing::Not(HasSubstr(". Before: not judged")));
}

TEST_F(Up, NamesAPairWithoutAnAnswer) {
  std::ofstream(rig, std::ios::app) << "[[sensor]]\nname = \"radar\"\nchannel = \"RADAR\"\n"
                                       "[[pair]]\na = \"lidar\"\nb = \"radar\"\n";
  ChildProcess egocal = up({"--log", log, "--speed", "0"});
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> radar: no answer"));
}

// The diagnosis keeps 1200 poses of a stream, the page shows all: here it was killed after it had seen the
// bump.
TEST_F(Up, APageThatContradictsEndsWithThreeWhateverTheProcessesSaid) {
  ASSERT_EQ(ChildProcess({paths::bin_dir() + "/egocal", "simulate", "--out", log, "--rig-out", rig, "--poses",
                          "600", "--noise", "0.001", "--terrain", "free", "--bump", "camera=20:0,0,0,0,6,0"})
                .wait(60s),
            0);
  const std::string url = "udpm://239.255.76.67:7778?ttl=0";
  bus::Loop loop(url, bus::LoopOptions{.handle_signals = false});
  std::int64_t motions = 0;
  loop.subscribe<problem_t>(
      bus::problem_channel("lidar", "camera"),
      [&](const problem_t& problem, const bus::Arrival&) { motions = problem.matched; });
  ChildProcess egocal = up({"--log", log, "--speed", "10", "--report", "--lcm-url", url});
  ASSERT_TRUE(until([&] {
    loop.run_once(5ms);
    return motions > 300;
  }));
  send_signal(child(egocal.pid(), "egocal-diagnosi"), SIGKILL);  // its successor knows nothing of the bump
  EXPECT_EQ(egocal.wait(60s), 3) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("report-lidar-camera.html: contradictory: The mounting changed"));
}

// Here by solvers that are gone; one that hangs leaves the same.
TEST_F(Up, AnAnswerWithoutTheEndOfTheLogIsNotOneOfTheLog) {
  std::filesystem::create_directory(path("bin"));
  std::filesystem::copy_file(paths::bin_dir() + "/egocal", path("bin/egocal"));
  for (const char* name :
       {"egocal-pairing", "egocal-fast", "egocal-global", "egocal-diagnosis", "egocal-player"})
    std::filesystem::create_symlink(paths::bin_dir() + "/" + name, path("bin/" + std::string(name)));
  const std::string url = "udpm://239.255.76.67:7756?ttl=0";
  bus::Loop loop(url, bus::LoopOptions{.handle_signals = false});
  bool good = false;
  loop.subscribe<verdict_t>(
      bus::verdict_channel("lidar", "camera"),
      [&](const verdict_t& verdict, const bus::Arrival&) { good = verdict.verdict == "good"; });
  ChildProcess egocal({path("bin/egocal"), "up", rig, "--log", log, "--speed", "3", "--output-dir",
                       path("out"), "--lcm-url", url},
                      path("said"));
  ASSERT_TRUE(until([&] { return all_run(egocal.pid(), calibrating); }));
  std::this_thread::sleep_for(3s);  // they have started well: a program that is gone is looked for again
  ASSERT_TRUE(until([&] {
    loop.run_once(5ms);
    return good;
  }));
  for (const char* name : {"egocal-fast", "egocal-global"}) {
    std::filesystem::remove(path("bin/" + std::string(name)));
    send_signal(child(egocal.pid(), name), SIGKILL);
  }
  EXPECT_EQ(egocal.wait(60s), 3) << read(path("said"));
  const std::string said = read(path("said"));
  EXPECT_THAT(said, HasSubstr("lidar -> camera: no solver answers the motions of the last 5 s"));
  EXPECT_THAT(said, HasSubstr("lidar -> camera: old answer, the last "));
  EXPECT_THAT(said, HasSubstr("are not in it (no solver answered them). Before: good: "));
}

// As a recorder that rotates its logs does. It was "nothing was calibrated: no solver answered".
TEST_F(Up, ALogThatIsRemovedWhileItIsPlayedIsStillPlayedAndJudged) {
  ChildProcess egocal = up({"--log", log, "--speed", "10"});
  ASSERT_TRUE(until([&] { return std::filesystem::exists(path("out/pairing-1.state")); }));
  std::this_thread::sleep_for(1s);
  std::filesystem::remove(log);
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("lidar -> camera: good: "));
  EXPECT_THAT(read(path("said")), HasSubstr(", 400 motion pairs; "));
}

// It was "no solver answered".
TEST_F(Up, SaysWhyNothingWasCalibrated) {
  {
    bus::LogReader all(log);
    bus::LogWriter writer(path("held.log"));
    odometry_t held{};
    for (int i = 0; const auto event = all.next();) {
      odometry_t pose{};
      ASSERT_GE(pose.decode(event->data.data(), 0, static_cast<int>(event->data.size())), 0);
      if (event->channel == "ODOMETRY_CAMERA") {
        if (i++ % 10 == 0) held = pose;
        std::copy(std::begin(held.pos), std::end(held.pos), pose.pos);
        std::copy(std::begin(held.quat), std::end(held.quat), pose.quat);
      }
      writer.write(event->time_us, event->channel, bus::encode(pose));
    }
    writer.close();
  }
  ChildProcess egocal = up({"--log", path("held.log"), "--speed", "0"});
  EXPECT_EQ(egocal.wait(60s), 1) << read(path("said"));
  EXPECT_THAT(read(path("said")),
              HasSubstr("nothing was calibrated: pairing found no motion: it rejected 36"));
  EXPECT_THAT(read(path("said")), HasSubstr(" x frozen (one odometry repeats the same pose"));
}

TEST_F(Up, FailsWhereNothingWasCalibrated) {
  {
    bus::LogReader all(log);
    bus::LogWriter writer(path("short.log"));
    for (int i = 0; i < 2; ++i)
      if (const auto event = all.next()) writer.write(event->time_us, event->channel, event->data);
    writer.close();
  }
  ChildProcess egocal = up({"--log", path("short.log"), "--speed", "0"});
  EXPECT_EQ(egocal.wait(60s), 1) << read(path("said"));
  EXPECT_THAT(read(path("said")), HasSubstr("nothing was calibrated"));
}

/// The keys of the live programs were in no page.
TEST_F(Up, WhatListenAndTheMonitorPrintAsJsonIsDescribed) {
  const std::string url = "udpm://239.255.76.67:7779?ttl=0", listened = path("listened"),
                    watched = path("watched"), bin = paths::bin_dir();
  ChildProcess egocal = up({"--log", log, "--speed", "3", "--lcm-url", url});
  ChildProcess monitor({bin + "/egocal-monitor", "--rig", rig, "--lcm-url", url, "--json"}, watched);
  ASSERT_TRUE(until([&] { return read(watched).find("rotation_wxyz") != std::string::npos; }));
  ChildProcess listen({bin + "/egocal", "listen", rig, "--lcm-url", url, "--json", "--seconds", "2"},
                      listened);
  EXPECT_EQ(egocal.wait(60s), 0) << read(path("said"));
  listen.wait(20s);
  monitor.signal(SIGINT);
  EXPECT_EQ(monitor.wait(20s), 0);
  // a window of two seconds had never ended by then
  EXPECT_TRUE(nlohmann::json::parse(read(listened))["sensors"][0]["heard"]["rate_hz"].is_number())
      << read(listened);
  test::Keys keys;
  test::collect(nlohmann::json::parse(read(listened)), "", keys);
  // of channels that are not in the rig file, and of what is wrong
  for (const char* key : {"channel", "type", "messages", "rate_hz", "silent_s", "faults"})
    keys.insert(std::string("others[].") + key);
  for (const char* key : {"reason", "count", "cure"})
    keys.insert(std::string("sensors[].heard.faults[].") + key);
  keys.erase("others");
  keys.erase("sensors[].heard.faults");
  keys.insert("sensors[].heard");  // where nothing was received
  test::compare_with_page("listen", keys);
  keys.clear();
  std::istringstream lines(read(watched));
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("{")) test::collect(nlohmann::json::parse(line), "", keys);
  EXPECT_TRUE(keys.contains("pairs[].answer.translation")) << read(watched);
  EXPECT_TRUE(keys.contains("pairs[].fit.rotation_deg_median"));
  // a session with three pairs, mistakes, a goal, an unknown scale and one before it
  for (const char* key :
       {"sensors", "rotation_deg", "translation_m", "rotation_limit_deg", "translation_limit_m", "open"})
    keys.insert(std::string("loops[].") + key);
  for (const char* key : {"pairs[].findings[].code", "pairs[].goal.reached", "pairs[].scale.value",
                          "pairs[].previous_session.session"})
    keys.insert(key);
  test::compare_with_page("egocal-monitor", keys);
}

}  // namespace
}  // namespace egocal::test_up
