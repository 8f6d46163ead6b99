// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The monitor in a terminal beside other processes: commands, hostile senders, pauses and deaths, the load of
// many pairs, and its output into pipes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <regex>
#include <utility>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "scene.hpp"
#include "support/child_process.hpp"
#include "support/network_namespace.hpp"
#include "support/paths.hpp"
#include "terminal_session.hpp"
#include "tmux.hpp"

namespace egocal {

using namespace std::chrono_literals;
using ::testing::MatchesRegex;
using ::testing::Not;

TEST(Terminal, StandardErrorIsShownUnderEventsAndDoesNotTearTheScreen) {
  Tmux tmux(100, 30, script(environment("xterm-256color"), "--log " + recording));
  expect_screen(tmux, expected("overview", 100, 30, false));
  {
    std::ofstream its_standard_error("/proc/" + std::to_string(pid_in(tmux)) + "/fd/2");
    its_standard_error << "a library says: sendto failed\x1b[31m\n";
  }
  tmux.keys("e");
  ASSERT_TRUE(until([&] { return tmux.shows("a library says: sendto failed?[31m"); })) << tmux.screen();
  EXPECT_TRUE(tmux.shows("stderr"));
  tmux.keys("Escape");
  ASSERT_TRUE(until([&] { return tmux.shows("Sensor pairs"); }));
  tmux.keys("q");
  expect_shell_is_back(tmux);
}

TEST(Terminal, KeysAskBeforeTheyCommand) {
  const std::string url = "udpm://239.255.76.67:7671?ttl=0";
  setenv("LCM_DEFAULT_URL", url.c_str(), 1);
  test::ChildProcess source({feeder, "2", "20", "1000"});
  unsetenv("LCM_DEFAULT_URL");
  std::vector<command_t> commands;
  bus::Loop loop(url, {.handle_signals = false});
  loop.subscribe<command_t>(bus::command_channel,
                            [&](const command_t& c, const bus::Arrival&) { commands.push_back(c); });
  const auto heard = [&](std::size_t n) {
    return until([&] {
      loop.run_once(1ms);
      return commands.size() >= n;
    });
  };

  Tmux tmux(110, 35, script(environment("xterm-256color"), "--lcm-url " + url));
  ASSERT_TRUE(until([&] { return tmux.shows("lidar → camera1"); })) << tmux.screen();
  tmux.keys("r");
  ASSERT_TRUE(until([&] { return tmux.shows("Forget all motions of lidar → camera0?"); })) << tmux.screen();
  tmux.keys("n");
  ASSERT_TRUE(until([&] { return tmux.shows("nothing done"); })) << tmux.screen();
  tmux.keys("Down");
  tmux.keys("r");
  ASSERT_TRUE(until([&] { return tmux.shows("Forget all motions of lidar → camera1?"); })) << tmux.screen();
  tmux.keys("y");
  ASSERT_TRUE(heard(1));
  EXPECT_EQ(commands[0].verb, "reset");
  EXPECT_EQ(commands[0].sensor_b, "camera1");
  EXPECT_EQ(commands[0].session, begin_utime);
  tmux.keys("p");
  ASSERT_TRUE(until([&] { return tmux.shows("Pause the calibration of lidar → camera1?"); }));
  tmux.keys("Escape");
  ASSERT_TRUE(until([&] { return tmux.shows("nothing done"); }));
  tmux.keys("p");
  tmux.keys("y");
  ASSERT_TRUE(heard(2));
  EXPECT_EQ(commands[1].verb, "pause");
  ASSERT_EQ(commands.size(), 2u) << "nothing is sent that was not confirmed";
  tmux.keys("Up");
  ASSERT_TRUE(until([&] { return tmux.shows("q quit"); })) << tmux.screen();
  tmux.keys("Down");

  tmux.keys("Space");
  ASSERT_TRUE(until([&] { return tmux.shows("VIEW PAUSED"); }));
  std::string still;
  until([&] {  // all of it is drawn
    const std::string before = std::exchange(still, tmux.screen());
    return still == before;
  });
  std::this_thread::sleep_for(500ms);
  EXPECT_EQ(tmux.screen(), still);
  tmux.keys("Space");
  ASSERT_TRUE(until([&] { return !tmux.shows("VIEW PAUSED") && tmux.screen() != still; }));

  for (const auto& [key, file] : {std::pair{"y", "extrinsic_lidar_camera1.yaml"},
                                  {"u", "extrinsic_lidar_camera1.urdf"},
                                  {"r", "extrinsic_lidar_camera1.ros.sh"},
                                  {"k", "extrinsic_lidar_camera1.kalibr.yaml"},
                                  {"y", "extrinsic_lidar_camera1-2.yaml"}}) {
    tmux.keys("x");
    ASSERT_TRUE(until([&] { return tmux.shows("Write the answer"); }));
    tmux.keys(key);
    ASSERT_TRUE(until([&, name = file] { return tmux.shows(std::string("wrote ") + name); }))
        << tmux.screen();
    EXPECT_THAT(read_text(tmux.folder() / file), HasSubstr("lidar")) << file;
  }
  source.signal(SIGKILL);
  ASSERT_TRUE(until([&] { return tmux.shows(" 2 old"); })) << tmux.screen();
  tmux.keys("x");
  tmux.keys("y");
  ASSERT_TRUE(until([&] {
    return tmux.shows("an old answer, not to be used: wrote extrinsic_lidar_camera1-3.yaml");
  })) << tmux.screen();
  tmux.keys("?");
  ASSERT_TRUE(until([&] { return tmux.shows("the best fit to the motions"); }));
  tmux.keys("q");  // closes the help, no more
  ASSERT_TRUE(until([&] { return !tmux.shows("the best fit to the motions"); }));
  tmux.keys("q");
  expect_shell_is_back(tmux);
}

TEST(Terminal, HostileSendersReachNeitherTheTerminalNorTheTitle) {
  const std::string url = "udpm://239.255.76.67:7672?ttl=0";
  setenv("LCM_DEFAULT_URL", url.c_str(), 1);
  test::ChildProcess source({feeder, "4", "50", "1000", "hostile"});
  unsetenv("LCM_DEFAULT_URL");
  Tmux tmux(120, 40, "read go\n" + script(environment("xterm-256color"), "--lcm-url " + url));
  tmux.run("pipe-pane -t s 'cat > " + (tmux.folder() / "raw").string() + "'");
  tmux.keys("Enter");
  ASSERT_TRUE(until([&] { return tmux.shows("lidar → camera3"); })) << tmux.screen();
  for (const char* key : {"Enter", "n", "n", "n", "l", "e", "Escape", "?"}) {
    tmux.keys(key);
    std::this_thread::sleep_for(150ms);
    EXPECT_TRUE(tmux.alternate_screen());
  }
  tmux.keys("Escape");
  ASSERT_TRUE(until([&] { return !tmux.shows("the best fit to the motions"); })) << tmux.screen();
  tmux.keys("q");
  expect_shell_is_back(tmux);
  EXPECT_EQ(read_text(tmux.folder() / "status"), "0\n");
  const std::string raw = read_text(tmux.folder() / "raw");
  EXPECT_GT(raw.size(), 1000u);
  EXPECT_THAT(raw, Not(HasSubstr("\x1b]")));
  EXPECT_THAT(raw, Not(HasSubstr("\x07")));
}

TEST(Terminal, FollowsRealProcessesThroughPauseResetAndDeath) {
  const std::string rig = paths::source_dir() + "/logs/drive.toml",
                    log = paths::source_dir() + "/logs/drive.log";
  const std::string url = "udpm://239.255.76.67:7674?ttl=0";
  const auto start = [&](const std::string& name, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{paths::bin_dir() + "/" + name, "--rig", rig, "--lcm-url", url};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::ChildProcess(arguments);
  };
  Tmux tmux(110, 42, script(environment("xterm-256color"), "--rig " + rig + " --lcm-url " + url));
  ASSERT_TRUE(until([&] { return tmux.shows("no motions yet"); })) << tmux.screen();
  test::ChildProcess pairing = start("egocal-pairing"), fast = start("egocal-fast"),
                     global = start("egocal-global");
  ASSERT_TRUE(until([&] {
    return tmux.shows("egocal-pairing   running") && tmux.shows("egocal-fast      running") &&
           tmux.shows("egocal-global");
  })) << tmux.screen();
  test::ChildProcess player = start("egocal-player", {log, "--speed", "2"});
  ASSERT_TRUE(until([&] { return tmux.shows("optimal (proven)"); })) << tmux.screen();
  EXPECT_TRUE(until([&] { return tmux.shows("error"); })) << "the rig knows the truth";

  tmux.keys("p");
  tmux.keys("y");
  ASSERT_TRUE(until([&] { return tmux.shows("PAUSED") && tmux.shows("egocal-pairing   paused"); }))
      << tmux.screen();
  tmux.keys("p");
  ASSERT_TRUE(until([&] { return tmux.shows("Resume the calibration"); })) << tmux.screen();
  tmux.keys("y");
  ASSERT_TRUE(until([&] { return !tmux.shows("PAUSED") && tmux.shows("egocal-pairing   running"); }))
      << tmux.screen();
  // a paused view shows what was, and asks about what is
  tmux.keys("Space");
  ASSERT_TRUE(until([&] { return tmux.shows("VIEW PAUSED"); })) << tmux.screen();
  for (const char* question : {"Pause the calibration", "Resume the calibration"}) {
    tmux.keys("p");
    ASSERT_TRUE(until([&] { return tmux.shows(question); })) << tmux.screen();
    tmux.keys("y");
    ASSERT_TRUE(until([&] { return tmux.shows(" sent"); })) << tmux.screen();
    std::this_thread::sleep_for(2s);  // two heartbeats: they say so, too
  }
  tmux.keys("Space");
  ASSERT_TRUE(until([&] { return !tmux.shows("PAUSED") && tmux.shows("egocal-pairing   running"); }))
      << tmux.screen();
  tmux.keys("r");
  tmux.keys("y");
  ASSERT_TRUE(until([&] { return tmux.shows("session reset, as asked for"); })) << tmux.screen();
  ASSERT_TRUE(until([&] { return tmux.shows("optimal (proven)"); })) << tmux.screen();

  global.signal(SIGKILL);
  ASSERT_TRUE(until([&] { return tmux.shows("GONE") && tmux.shows("process is gone"); })) << tmux.screen();
  global = start("egocal-global");
  ASSERT_TRUE(until([&] { return !tmux.shows("GONE") && tmux.shows("process is back"); })) << tmux.screen();
  tmux.keys("q");
  expect_shell_is_back(tmux);
}

// Time on the processor [s] that a process has used, all threads.
double processor_time(pid_t pid) {
  const std::string text = read_text("/proc/" + std::to_string(pid) + "/stat");
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double characters_written(pid_t pid) {
  const std::string text = read_text("/proc/" + std::to_string(pid) + "/io");
  const auto at = text.find("wchar: ");
  return at == std::string::npos ? 0 : std::stod(text.substr(at + 7));
}

TEST(Terminal, TwentyPairsAtAHundredHertzCostLittle) {
  const std::string url = "udpm://239.255.76.67:7673?ttl=0";
  setenv("LCM_DEFAULT_URL", url.c_str(), 1);
  test::ChildProcess source({feeder, "20", "100", "1000"});
  unsetenv("LCM_DEFAULT_URL");
  Tmux tmux(120, 40, script(environment("xterm-256color"), "--lcm-url " + url));
  ASSERT_TRUE(until([&] { return tmux.shows("lidar → camera19"); })) << tmux.screen();
  const pid_t pid = pid_in(tmux);
  for (const char* key : {"", "Enter"}) {
    if (*key) tmux.keys(key);
    std::this_thread::sleep_for(1s);
    const auto begin = std::chrono::steady_clock::now();
    const double used = processor_time(pid), written = characters_written(pid);
    std::this_thread::sleep_for(5s);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double percent = 100 * (processor_time(pid) - used) / seconds;
    const double rate = (characters_written(pid) - written) / seconds;
    std::printf("%s: %.1f %% of a core, %.1f kB/s to the terminal\n", *key ? "detail" : "overview", percent,
                rate / 1e3);
    // 5 to 8 % on an idle machine; 16 % was seen beside other tests and a compiler. Drawing all again with
    // every message would cost more than a core.
    EXPECT_LT(percent, 40) << (*key ? "detail" : "overview");
    EXPECT_GT(percent, 0.1) << "it has drawn nothing";
    EXPECT_LT(rate, 60e3) << "redraws what did not change";
  }
  tmux.keys("q");
  expect_shell_is_back(tmux);
}

namespace {

std::string last_line_of(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  return end == std::string::npos ? "" : text.substr(text.rfind('\n', end) + 1);
}

}  // namespace

// One bit of one stamp: the monitor waited for years, or showed them.
TEST(WithoutATerminal, ADamagedStampCausesNoWait) {
  const std::filesystem::path damaged = scratch / "damaged.log";
  {
    bus::LogReader from(recording);
    bus::LogWriter to(damaged);
    for (int i = 0; const std::optional<bus::LogEvent> event = from.next(); ++i)
      to.write(event->time_us ^ (i == 300 ? std::int64_t{1} << 54 : 0), event->channel, event->data);
    to.close();
  }
  const std::string follow = environment("xterm") + "timeout 30 " + program + " --follow --json --log ";
  const Output undamaged = output_of(follow + recording + " --speed 0 2>&1");
  EXPECT_EQ(undamaged.status, 0);
  const Output at_once = output_of(follow + damaged.string() + " --speed 0 2>&1");
  // how many lines come before the last one depends on how long the reading takes
  EXPECT_EQ(last_line_of(at_once.text), last_line_of(undamaged.text));
  EXPECT_EQ(output_of(follow + damaged.string() + " --speed 100 2>&1").status, 0);
}

TEST(WithoutATerminal, AnOutputThatCannotBeWrittenIsAnError) {
  for (const std::string option : {" --follow --json", " --follow", " --once", " --once --size 80x24"}) {
    const Output full = output_of(environment("xterm") + program + " --log " + recording + option +
                                  " 2>&1 >/dev/full < /dev/null");
    EXPECT_EQ(full.status, 1) << option;
    EXPECT_THAT(full.text, HasSubstr("standard output: cannot be written: No space left")) << option;
  }
}

TEST(WithoutATerminal, LinesAndObjectsForPipes) {
  const std::string log = " --log " + recording;
  const Output once = output_of(environment("xterm") + program + log + " --once 2>&1");
  EXPECT_EQ(once.status, 0);
  EXPECT_THAT(once.text, HasSubstr("optimal (proven) by egocal-fast (sqp), 200 motions"));
  EXPECT_THAT(once.text, HasSubstr("egocal-fast: running, pid 4711 on car"));
  EXPECT_THAT(once.text, Not(HasSubstr("\x1b")));
  const Output json = output_of(environment("xterm") + program + log + " --once --json 2>&1");
  EXPECT_EQ(json.text.find('\n'), json.text.size() - 1);
  EXPECT_THAT(json.text, HasSubstr("\"certified\":true"));
  const Output follow = output_of(environment("xterm", "C") + program + log + " < /dev/null 2>&1 | head -3");
  EXPECT_THAT(follow.text, HasSubstr("standard input and output are no terminal: printing lines instead"));
  for (char c : follow.text) EXPECT_TRUE(static_cast<unsigned char>(c) < 0x7f) << follow.text;
}

// Its own heartbeat comes back to it, and is nothing received.
TEST(WithoutATerminal, NothingReceivedIsAFailure) {
  for (const std::string arguments :
       {"--once --timeout 1.5", "--once --timeout 1.5 --json", "--follow --duration 1.5"}) {
    const Output output = output_of(environment("xterm") + program +
                                    " --lcm-url udpm://239.255.76.67:7689?ttl=0 " + arguments + " 2>&1");
    EXPECT_EQ(output.status, 1) << arguments;
    EXPECT_THAT(output.text, HasSubstr("egocal-monitor: nothing received on udpm://239.255.76.67:7689"));
  }
}

TEST(WithoutARoute, OneClearLine) {
  const Output output =
      output_of("unshare --net timeout 60 " + program + " --once --timeout 1 2>&1; echo exit $?");
  EXPECT_THAT(output.text, MatchesRegex("egocal-monitor: no multicast to 239.255.76.67: [^\n]*ip route add "
                                        "224.0.0.0/4 dev lo\nexit 1\n"));
}

}  // namespace egocal
