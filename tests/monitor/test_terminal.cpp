// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The real monitor in a real terminal (tmux): what reaches the screen, and in what state the terminal is
// left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <regex>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "scene.hpp"
#include "support/child_process.hpp"
#include "support/network_namespace.hpp"
#include "support/paths.hpp"
#include "tmux.hpp"

namespace egocal {
namespace {

using namespace std::chrono_literals;
using monitor::test::begin_utime;
using monitor::test::calibration_at;
using monitor::test::problem_at;
using monitor::test::status_of;
using test::Output;
using test::output_of;
using test::read_text;
using test::Tmux;
using test::trimmed;
using test::until;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

const std::string program = paths::bin_dir() + "/egocal-monitor";
const std::string feeder = paths::test_dir() + "/egocal-monitor-feeder";
std::filesystem::path scratch;  // of this run, with the recorded session in it
std::string recording;

const std::string evil_name = "\x1b[2J\x1b]0;owned\x07\xff" + std::string(120, 'W');

// Twenty seconds of two well-behaved pairs and a hostile one: the same on every machine.
void write_recording() {
  bus::LogWriter log(recording);
  for (std::int64_t step = 0; step < 200; ++step) {
    const std::int64_t now = begin_utime + step * 100'000;
    for (const std::string b : {"camera", "radar", "evil"}) {
      problem_t problem = problem_at("lidar", b, step, 10, 4);
      calibration_t fast = calibration_at(problem, false), global = calibration_at(problem, true);
      if (b == "evil") {
        problem.sensor_a = fast.sensor_a = global.sensor_a = evil_name;
        fast.pos[1] = fast.scaled_gap = std::numeric_limits<double>::quiet_NaN();
        fast.hint = evil_name;
      }
      log.write(now, "EGOCAL_PROBLEM_lidar_" + b, bus::encode(problem));
      log.write(now + 300, "EGOCAL_CALIBRATION_lidar_" + b, bus::encode(fast));
      if (step < 50) log.write(now + 400, "EGOCAL_CALIBRATION_lidar_" + b, bus::encode(global));
    }
    if (step % 10 == 0)
      for (const char* role : {"player", "pairing", "global", "fast"}) {
        status_t status = status_of(std::string("egocal-") + role, role, step * 3);
        if (step == 150 && std::string(role) == "global") status.state = "ended";
        if (step > 150 && std::string(role) == "global") continue;
        log.write(now + 500, bus::status_channel, bus::encode(status));
      }
  }
  log.close();
}

std::string environment(const std::string& term, const std::string& locale = "C.UTF-8") {
  return "env -u NO_COLOR -u LANG -u LC_CTYPE TZ=UTC0 TERM=" + term + " LC_ALL=" + locale + " ";
}

// What the screen has to show: the same canvas, printed without a terminal.
std::string expected(const std::string& screen, int width, int height, bool ascii) {
  const Output output = output_of(environment("dumb") + program + " --log " + recording +
                                  " --once --screen " + screen + " --size " + std::to_string(width) + "x" +
                                  std::to_string(height) + (ascii ? " --ascii" : ""));
  EXPECT_EQ(output.status, 0);
  return trimmed(output.text);
}

// The monitor between two looks at the terminal's state; its pid and exit code are left in files.
std::string script(const std::string& env, const std::string& arguments) {
  return "trap : INT\nstty -a > before\n"
         "sh -c 'echo $$ > pid; exec " +
         env + program + " " + arguments +
         "'\n"
         "echo $? > status\nstty -a > after\necho the shell is back\nread line\n";
}

pid_t pid_in(const Tmux& tmux) {
  EXPECT_TRUE(until([&] { return !read_text(tmux.folder() / "pid").empty(); }));
  return static_cast<pid_t>(std::stol("0" + read_text(tmux.folder() / "pid")));
}

void expect_screen(const Tmux& tmux, const std::string& text) {
  std::string seen;
  until([&] { return (seen = tmux.screen()) == text; });
  EXPECT_EQ(seen, text);
}

// What `stty -a` said, but for the size, which is not ours to keep.
std::string modes(const std::filesystem::path& file) {
  return std::regex_replace(read_text(file), std::regex("rows [0-9]+; columns [0-9]+; "), "");
}

void expect_shell_is_back(const Tmux& tmux) {
  ASSERT_TRUE(until([&] { return tmux.shows("the shell is back"); })) << tmux.screen();
  const std::string before = modes(tmux.folder() / "before");
  EXPECT_THAT(before, HasSubstr("icanon"));
  EXPECT_EQ(modes(tmux.folder() / "after"), before);
  EXPECT_FALSE(tmux.alternate_screen());
  EXPECT_TRUE(tmux.cursor_visible());
  EXPECT_EQ(tmux.ask("#{keypad_flag}#{keypad_cursor_flag}"), "00");
  // no colour or weight is left behind
  std::istringstream lines(tmux.coloured_screen());
  for (std::string line; std::getline(lines, line);) {
    if (line.find("the shell is back") != std::string::npos) {
      EXPECT_EQ(line, "the shell is back");
    }
  }
}

}  // namespace

struct Kind {
  friend std::ostream& operator<<(std::ostream& out, const Kind& kind) {
    return out << kind.term << " " << kind.locale;
  }
  const char* term;
  const char* locale;
  bool ascii;
  bool colours;
};

class EveryTerminal : public testing::TestWithParam<Kind> {};

TEST_P(EveryTerminal, ShowsWhatTheViewsDrewAndIsLeftAsItWas) {
  const Kind& kind = GetParam();
  Tmux tmux(100, 30, script(environment(kind.term, kind.locale), "--log " + recording));
  const std::string overview = expected("overview", 100, 30, kind.ascii);
  expect_screen(tmux, overview);
  EXPECT_FALSE(tmux.cursor_visible() && std::string(kind.term) != "vt100");  // a vt100 cannot hide it
  const std::string arrow = kind.ascii ? "lidar -> camera" : "lidar → camera";
  EXPECT_THAT(overview, HasSubstr(arrow));
  EXPECT_THAT(overview, HasSubstr("optimal (proven)"));

  const std::string coloured = tmux.coloured_screen();
  EXPECT_EQ(std::regex_search(coloured, std::regex("\x1b\\[[0-9;]*3[1-7]")), kind.colours);
  EXPECT_THAT(coloured, Not(HasSubstr("38;5")));  // eight colours do

  tmux.keys("Enter");
  const std::string detail = expected("detail", 100, 30, kind.ascii);
  expect_screen(tmux, detail);
  bool braille = false, beyond_ascii = false;
  for (std::size_t i = 0; i < detail.size(); ++i) {
    const auto byte = static_cast<unsigned char>(detail[i]);
    beyond_ascii = beyond_ascii || byte > 0x7e;
    if (detail.compare(i, 2, "\xe2\xa0") >= 0 && detail.compare(i, 2, "\xe2\xa3") <= 0) braille = true;
  }
  EXPECT_EQ(braille, !kind.ascii);
  EXPECT_EQ(beyond_ascii, !kind.ascii);

  tmux.keys("e");
  expect_screen(tmux, expected("events", 100, 30, kind.ascii));
  tmux.keys("q");
  expect_shell_is_back(tmux);
  EXPECT_EQ(read_text(tmux.folder() / "status"), "0\n");
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, EveryTerminal,
    testing::Values(Kind{"xterm-256color", "C.UTF-8", false, true}, Kind{"xterm-256color", "C", true, true},
                    Kind{"xterm", "C.UTF-8", false, true}, Kind{"xterm", "C", true, true},
                    Kind{"screen", "C.UTF-8", false, true}, Kind{"screen", "C", true, true},
                    Kind{"linux", "C.UTF-8", true, true}, Kind{"linux", "C", true, true},
                    Kind{"vt100", "C.UTF-8", true, false}, Kind{"vt100", "C", true, false}),
    [](const auto& kind) {
      std::string name = std::string(kind.param.term) + (kind.param.locale[1] ? "_utf8" : "_c");
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

TEST(Terminal, ADumbOneGetsPlainLines) {
  for (const std::string term : {"dumb", "unknown-terminal"}) {
    Tmux tmux(160, 40, "read go\n" + script(environment(term), "--log " + recording));
    tmux.run("pipe-pane -t s 'cat > " + (tmux.folder() / "raw").string() + "'");
    tmux.keys("Enter");
    expect_shell_is_back(tmux);
    EXPECT_TRUE(tmux.shows("lidar -> camera: ")) << tmux.screen();
    std::string raw;
    EXPECT_TRUE(until([&] {
      return (raw = read_text(tmux.folder() / "raw")).find("the shell is back") != std::string::npos;
    }));
    EXPECT_THAT(raw, HasSubstr("printing lines instead"));
    for (char c : raw)
      ASSERT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\r') << term << "\n" << raw;
  }
}

TEST(Terminal, NoColoursWhereNoneAreWanted) {
  for (const std::string wish : {"--mono", "NO_COLOR"}) {
    const std::string env = environment("xterm-256color") + (wish == "NO_COLOR" ? "NO_COLOR=1 " : "");
    Tmux tmux(100, 30, script(env, "--log " + recording + (wish == "--mono" ? " --mono" : "")));
    expect_screen(tmux, expected("overview", 100, 30, false));
    const std::string screen = tmux.coloured_screen();
    EXPECT_FALSE(std::regex_search(screen, std::regex("\x1b\\[[0-9;]*3[0-8]"))) << wish;
    EXPECT_TRUE(std::regex_search(screen, std::regex("\x1b\\[[0-9;]*1m"))) << "bold says it";
  }
}

TEST(Terminal, FollowsItsSizeBackAndForth) {
  Tmux tmux(100, 30, script(environment("xterm-256color"), "--log " + recording + " --screen detail"));
  expect_screen(tmux, expected("detail", 100, 30, false));
  const std::pair<int, int> sizes[] = {{80, 24}, {140, 50}, {40, 8},  {7, 3},
                                       {1, 1},   {200, 60}, {20, 40}, {100, 30}};
  for (const auto& [w, h] : sizes) {
    tmux.resize(w, h);
    expect_screen(tmux, expected("detail", w, h, false));
  }
  // faster than it can draw
  for (int i = 0; i < 20; ++i) tmux.resize(60 + 5 * i, 12 + 2 * (i % 7));
  tmux.resize(90, 28);
  expect_screen(tmux, expected("detail", 90, 28, false));
  tmux.keys("q");
  expect_shell_is_back(tmux);
}

class EverySignal : public testing::TestWithParam<int> {};

TEST_P(EverySignal, LeavesTheTerminalAsItWas) {
  const int number = GetParam();
  for (const std::string term : {"xterm-256color", "vt100"}) {
    Tmux tmux(80, 24, script(environment(term), "--log " + recording + " --screen detail"));
    expect_screen(tmux, expected("detail", 80, 24, term == "vt100"));
    ASSERT_EQ(kill(pid_in(tmux), number), 0);
    expect_shell_is_back(tmux);
    const bool crash = number == SIGSEGV || number == SIGABRT;
    EXPECT_EQ(read_text(tmux.folder() / "status"), crash ? std::to_string(128 + number) + "\n" : "0\n");
  }
}

INSTANTIATE_TEST_SUITE_P(Signals, EverySignal,
                         testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGSEGV, SIGABRT),
                         [](const auto& kind) { return std::string("SIG") + sigabbrev_np(kind.param); });

TEST(Terminal, CtrlCEndsIt) {
  Tmux tmux(80, 24, script(environment("xterm"), "--log " + recording));
  expect_screen(tmux, expected("overview", 80, 24, false));
  tmux.keys("C-c");
  expect_shell_is_back(tmux);
}

TEST(Terminal, EndsWhenTheTerminalIsGone) {
  pid_t pid = 0;
  {
    Tmux tmux(80, 24, script(environment("xterm"), "--log " + recording));
    expect_screen(tmux, expected("overview", 80, 24, false));
    pid = pid_in(tmux);
    ASSERT_EQ(kill(pid, 0), 0);
  }
  EXPECT_TRUE(until([&] { return kill(pid, 0) != 0; })) << "still running";
}

TEST(Terminal, IsGivenBackWhileSuspendedAndTakenAgain) {
  // an interactive shell, as job control wants one; without its line editor, which has modes of its own
  Tmux tmux(80, 24, "PS1='shell> ' exec bash --norc --noprofile --noediting -i");
  ASSERT_TRUE(until([&] { return tmux.shows("shell>"); }));
  tmux.type("stty -a > before");
  tmux.type(environment("xterm-256color") + program + " --log " + recording);
  const std::string overview = expected("overview", 80, 24, false);
  for (int i = 0; i < 2; ++i) {
    expect_screen(tmux, overview);
    EXPECT_FALSE(tmux.cursor_visible());
    tmux.keys("C-z");
    ASSERT_TRUE(until([&] { return tmux.shows("Stopped"); })) << tmux.screen();
    EXPECT_FALSE(tmux.alternate_screen());
    EXPECT_TRUE(tmux.cursor_visible());
    tmux.type("stty -a > during; echo look at during");
    ASSERT_TRUE(until([&] { return tmux.shows("\nlook at during"); }));
    EXPECT_EQ(modes(tmux.folder() / "during"), modes(tmux.folder() / "before"));
    tmux.type("clear; fg");
  }
  expect_screen(tmux, overview);
  tmux.keys("C-z");
  ASSERT_TRUE(until([&] { return tmux.shows("Stopped"); }));
  tmux.resize(110, 35);  // while detached
  tmux.type("clear; fg");
  expect_screen(tmux, expected("overview", 110, 35, false));
  tmux.keys("q");
  ASSERT_TRUE(until([&] { return !tmux.alternate_screen() && tmux.cursor_visible(); }));
  tmux.type("stty -a > after; echo look at after");
  ASSERT_TRUE(until([&] { return tmux.shows("\nlook at after"); }));
  EXPECT_EQ(modes(tmux.folder() / "after"), modes(tmux.folder() / "before"));
}

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
  const std::string still = tmux.screen();
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
  tmux.keys("?");
  ASSERT_TRUE(until([&] { return tmux.shows("no other transform fits"); }));
  tmux.keys("q");  // closes the help, no more
  ASSERT_TRUE(until([&] { return !tmux.shows("no other transform fits"); }));
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
  tmux.keys("r");
  tmux.keys("y");
  ASSERT_TRUE(until([&] { return tmux.shows("session reset: the calibration starts again"); }))
      << tmux.screen();
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
    // 5 % is what is promised; a loaded machine with cold caches is given three times as much
    EXPECT_LT(percent, 15) << (*key ? "detail" : "overview");
    EXPECT_GT(percent, 0.1) << "it has drawn nothing";
    EXPECT_LT(rate, 60e3) << "redraws what did not change";
  }
  tmux.keys("q");
  expect_shell_is_back(tmux);
}

TEST(WithoutATerminal, LinesAndObjectsForPipes) {
  const std::string log = " --log " + recording;
  const Output once = output_of(environment("xterm") + program + log + " --once 2>&1");
  EXPECT_EQ(once.status, 0);
  EXPECT_THAT(once.text, HasSubstr("optimal (proven) by egocal-fast (sqp), 200 frames"));
  EXPECT_THAT(once.text, HasSubstr("egocal-fast: running, pid 4711 on car"));
  EXPECT_THAT(once.text, Not(HasSubstr("\x1b")));
  const Output json = output_of(environment("xterm") + program + log + " --once --json 2>&1");
  EXPECT_EQ(json.text.find('\n'), json.text.size() - 1);
  EXPECT_THAT(json.text, HasSubstr("\"certified\":true"));
  const Output follow = output_of(environment("xterm", "C") + program + log + " < /dev/null 2>&1 | head -3");
  EXPECT_THAT(follow.text, HasSubstr("standard input and output are no terminal: printing lines instead"));
  for (char c : follow.text) EXPECT_TRUE(static_cast<unsigned char>(c) < 0x7f) << follow.text;
}

TEST(WithoutARoute, OneClearLine) {
  const Output output =
      output_of("unshare --net timeout 60 " + program + " --once --timeout 1 2>&1; echo exit $?");
  EXPECT_THAT(output.text, MatchesRegex("egocal-monitor: no multicast to 239.255.76.67: [^\n]*ip route add "
                                        "224.0.0.0/4 dev lo\nexit 1\n"));
}

}  // namespace egocal

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (!egocal::test::enter_network_namespace()) return 1;
  if (std::system("tmux -V > /dev/null") != 0) {
    std::fprintf(stderr, "these tests need tmux\n");
    return 1;
  }
  char name[] = "/tmp/egocal-terminal-XXXXXX";
  if (!mkdtemp(name)) return 1;
  egocal::scratch = name;
  egocal::recording = egocal::scratch / "scene.log";
  egocal::write_recording();
  const int result = RUN_ALL_TESTS();
  std::filesystem::remove_all(egocal::scratch);
  return result;
}
