// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// egocal-player as people use it: by options, by commands on the bus, by the keys of a terminal.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "support/child_process.hpp"
#include "support/network_namespace.hpp"
#include "support/paths.hpp"

namespace egocal {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t begin_us = 1'600'000'000'000'000;

class PlayerProcess : public ::testing::Test {
 protected:
  PlayerProcess() {
    static int port = 7760;
    url = "udpm://239.255.76.67:" + std::to_string(++port) + "?ttl=0";
    folder = std::filesystem::temp_directory_path() /
             ("egocal-player-" + std::to_string(getpid()) + "-" + std::to_string(port));
    std::filesystem::create_directories(folder);
    log = folder / "drive.log";
    loop = std::make_unique<bus::Loop>(url, bus::LoopOptions{.handle_signals = false});
    for (const std::string channel : {"LEFT", "RIGHT", "EGOCAL_PROBLEM_a_b"})
      loop->subscribe_bytes(channel, [this](const bus::Arrival& arrival) {
        odometry_t message{};
        if (bus::decode(arrival.bytes, message))
          heard.push_back(
              {arrival.channel, 1e-6 * static_cast<double>(message.utime - begin_us), arrival.mono_us});
      });
    loop->subscribe<status_t>(bus::status_channel,
                              [this](const status_t& message, const bus::Arrival&) { status = message; });
  }
  ~PlayerProcess() override {
    player.reset();
    std::filesystem::remove_all(folder);
  }

  /// Two channels in turn at these times [s].
  void write(const std::vector<double>& seconds) const {
    bus::LogWriter writer(log);
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      odometry_t message{};
      message.utime = begin_us + std::llround(1e6 * seconds[i]);
      message.quat[0] = 1;
      writer.write(message.utime, i % 2 ? "RIGHT" : "LEFT", bus::encode(message));
    }
    writer.close();
  }
  static std::vector<double> evenly(int count, double period) {
    std::vector<double> seconds;
    for (int i = 0; i < count; ++i) seconds.push_back(i * period);
    return seconds;
  }
  void start(std::vector<std::string> more = {}) {
    // there is no pairing process
    std::vector<std::string> arguments{
        paths::bin_dir() + "/egocal-player", log, "--lcm-url", url, "--wait-for-pairing", "0.2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    player = std::make_unique<ChildProcess>(arguments, folder / "said");
  }
  bool until(const std::function<bool()>& condition, std::chrono::milliseconds timeout = 30s) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      loop->run_once(5ms);
    }
    return true;
  }
  void listen(std::chrono::milliseconds time) {
    until([] { return false; }, time);
  }
  int ended() {
    int code = -1;
    until([&] { return (code = player->wait(0ms)) >= 0; });
    listen(20ms);
    return code;
  }
  void command(const std::string& verb, const std::string& to = "egocal-player") {
    command_t message{};
    message.to = to;
    message.verb = verb;
    loop->publish(bus::command_channel, message);
  }
  std::vector<double> times() const {
    std::vector<double> result;
    for (const Heard& event : heard) result.push_back(event.seconds);
    return result;
  }
  std::string said() const {
    std::ifstream stream(folder / "said");
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::int64_t counter(const std::string& name) const {
    for (const counter_t& c : status.counters)
      if (c.name == name) return c.value;
    return -1;
  }

  struct Heard {
    std::string channel;
    double seconds;
    std::int64_t mono_us;
  };
  std::string url, log;
  std::filesystem::path folder;
  std::unique_ptr<bus::Loop> loop;
  std::unique_ptr<ChildProcess> player;
  std::vector<Heard> heard;
  status_t status{};
};

TEST_F(PlayerProcess, PlaysARangeOfTheChosenChannelsInTime) {
  write(evenly(40, 0.1));
  start({"--start", "0.95", "--end", "2.45", "--channel", "LE.T"});
  EXPECT_EQ(ended(), 0);
  const std::vector<double> expected{1, 1.2, 1.4, 1.6, 1.8, 2, 2.2, 2.4};
  ASSERT_EQ(heard.size(), expected.size()) << said();
  // never early; late as far as the machine is busy, which is why four of them say when it began
  double began = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(heard[i].channel, "LEFT");
    EXPECT_NEAR(heard[i].seconds, expected[i], 1e-9);
    const double begins = 1e-6 * static_cast<double>(heard[i].mono_us) - (expected[i] - 1);
    if (i < 4)
      began = std::min(began, begins);
    else
      EXPECT_GT(begins, began - 0.1);
  }
}

TEST_F(PlayerProcess, SpeedIsThatOfTheOptionAndChangesLive) {
  write(evenly(100, 0.1));  // 10 s
  start({"--speed", "5", "--paused"});
  ASSERT_TRUE(until([&] { return status.state == "paused"; }));
  listen(700ms);  // no pairing to keep in step with: it continues alone
  EXPECT_TRUE(heard.empty());
  const std::int64_t resumed_us = loop->mono_us();
  command("resume");
  ASSERT_TRUE(until([&] { return heard.size() >= 40; })) << said();
  const double first = 1e-6 * static_cast<double>(heard[39].mono_us - resumed_us);
  EXPECT_GT(first, 3.9 / 5 - 0.01);
  EXPECT_LT(first, 3.9) << "not faster than recorded";
  command("speed 1000");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(ended(), 0);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
  EXPECT_EQ(heard.size(), 100u);
}

TEST_F(PlayerProcess, PausesStepsSeeksAndResumesByCommands) {
  write(evenly(60, 0.1));
  start({"--paused"});
  ASSERT_TRUE(until([&] { return status.state == "paused"; }));
  const auto stepped = [&](double seconds) {
    const std::size_t before = heard.size();
    command("step");
    ASSERT_TRUE(until([&] { return heard.size() > before; })) << said();
    listen(150ms);
    EXPECT_EQ(heard.size(), before + 1) << "one step, one event";
    EXPECT_NEAR(heard.back().seconds, seconds, 1e-9);
  };
  stepped(0);
  stepped(0.1);
  command("seek 3.05");
  stepped(3.1);
  stepped(3.2);
  command("seek 1");
  stepped(1);
  command("seek 1000");
  ASSERT_TRUE(until([&] { return said().find("nothing to play at 1000.0 s") != std::string::npos; }));
  stepped(1.1);  // stays where it was
  command("resume");
  ASSERT_TRUE(until([&] { return status.state == "running" && heard.back().seconds > 2; }));
  command("pause", "*");
  ASSERT_TRUE(until([&] { return status.state == "paused"; }));
  listen(100ms);
  const std::size_t count = heard.size();
  listen(500ms);
  EXPECT_EQ(heard.size(), count) << "paused";
  command("seek nowhere");
  ASSERT_TRUE(until([&] { return counter("rejected: command not understood") == 1; }));
  command("speed 100");
  command("resume");
  EXPECT_EQ(ended(), 0);
  EXPECT_NEAR(heard.back().seconds, 5.9, 1e-9);
  // every event after the pause once, in order
  for (std::size_t i = count; i < heard.size(); ++i)
    EXPECT_NEAR(heard[i].seconds, heard[i - 1].seconds + 0.1, 1e-9);
}

// It plays the file that it has opened, whatever its name has become.
TEST_F(PlayerProcess, SeeksInALogThatWasMoved) {
  write(evenly(60, 0.1));
  start({"--paused"});
  ASSERT_TRUE(until([&] { return status.state == "paused"; }));
  std::filesystem::remove(log);
  command("seek 3.05");
  ASSERT_TRUE(until([&] { return counter("seeks") == 1; })) << said();
  command("step");
  ASSERT_TRUE(until([&] { return !heard.empty(); })) << said();
  EXPECT_NEAR(heard.back().seconds, 3.1, 1e-9);
  command("speed 100");
  command("resume");
  EXPECT_EQ(ended(), 0);
  EXPECT_NEAR(heard.back().seconds, 5.9, 1e-9);
}

TEST_F(PlayerProcess, LoopsUntilItIsEnded) {
  write(evenly(10, 0.05));
  start({"--loop", "--start", "0.1", "--channel", "LEFT"});
  ASSERT_TRUE(until([&] { return heard.size() >= 9; }));
  player->signal(SIGINT);
  EXPECT_EQ(ended(), 0);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_NEAR(heard[i].seconds, std::vector<double>({0.1, 0.2, 0.3, 0.4})[i % 4], 1e-9);
  EXPECT_EQ(status.state, "ended");
}

TEST_F(PlayerProcess, SaysWhatDamageCostAndPlaysTheRest) {
  write(evenly(40, 0.05));
  bus::LogReader reader(log);
  std::vector<std::uint64_t> begins{0};
  while (reader.next()) begins.push_back(reader.position());
  std::fstream file(log, std::ios::in | std::ios::out | std::ios::binary);
  const auto put = [&](std::uint64_t at, const std::string& bytes) {
    file.seekp(static_cast<std::streamoff>(at));
    file << bytes;
  };
  put(begins[5], std::string(2, 'x'));                    // no sync word
  put(begins[20] + 24, std::string("\xff\xff\xff\xff"));  // a length of -1
  put(begins[30] + 12, std::string("\x00\x7f", 2));       // a time in the year 1000000
  file.close();
  std::filesystem::resize_file(log, begins.back() - 3);
  start();
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(heard.size(), 37u);
  const std::uint64_t lost = begins[6] - begins[5] + begins[21] - begins[20] + begins[40] - begins[39] - 3;
  EXPECT_THAT(said(), HasSubstr("3 damaged regions skipped, " + std::to_string(lost) +
                                " bytes and at least 3 events lost; the log is cut off"));
  EXPECT_THAT(said(),
              HasSubstr("the log is damaged here: " + std::to_string(begins[6] - begins[5]) + " bytes"));
  EXPECT_THAT(said(), HasSubstr("1 events with damaged times"));
  EXPECT_EQ(counter("lost: damaged regions of the log"), 3);
  EXPECT_EQ(counter("lost: damaged bytes of the log"), static_cast<std::int64_t>(lost));
  EXPECT_EQ(counter("lost: events of the log"), 3);
}

TEST_F(PlayerProcess, AGapIsAnnouncedOnceAndCanBeSkipped) {
  write({0, 0.1, 0.2, 600, 600.1});
  start();
  ASSERT_TRUE(until([&] { return heard.size() == 3 && !status.last_error.empty(); })) << said();
  EXPECT_THAT(status.last_error, HasSubstr("gap in the log, nothing until 600.0 s into it"));
  listen(1200ms);
  command("pause");  // and what was waited for goes on from where it was, not from the gap's end
  ASSERT_TRUE(until([&] { return status.state == "paused"; }));
  command("resume");
  ASSERT_TRUE(until([&] { return status.state == "running"; }));
  listen(300ms);
  EXPECT_EQ(heard.size(), 3u);
  const std::string text = said();
  const std::size_t first = text.find("gap in the log");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("gap in the log", first + 1), std::string::npos) << text;
  command("seek 600");
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(heard.size(), 5u);
  EXPECT_EQ(status.last_error, "");
}

TEST_F(PlayerProcess, OwnChannelsOfAnotherDayStayInTheLog) {
  {
    bus::LogWriter writer(log);
    odometry_t message{};
    message.utime = begin_us;
    for (const std::string channel : {"LEFT", "EGOCAL_PROBLEM_a_b", "RIGHT"})
      writer.write(begin_us, channel, bus::encode(message));
    writer.close();
  }
  start();
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(heard.size(), 2u);
  EXPECT_THAT(said(), HasSubstr("1 events of egocal's own channels (EGOCAL_*) were skipped"));
  start({"--channel", ".*"});
  EXPECT_EQ(ended(), 0);
  EXPECT_EQ(heard.size(), 5u);
}

TEST_F(PlayerProcess, WrongLogsAndOptionsAreRefused) {
  write(evenly(3, 0.1));
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--start", "99"}, {"--channel", "NONE"}, {"--channel", "("}}) {
    std::filesystem::remove(folder / "said");
    start(more);
    EXPECT_EQ(ended(), 1);
    const std::string text = said();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  }
  start({"--speed", "-1"});
  EXPECT_EQ(ended(), 2);
}

/// The player on a terminal of its own.
class OnTerminal : public PlayerProcess {
 protected:
  void start(std::vector<std::string> more) {
    std::vector<std::string> arguments{paths::bin_dir() + "/egocal-player", log, "--lcm-url", url};
    arguments.insert(arguments.end(), more.begin(), more.end());
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    int slave = -1;
    ASSERT_EQ(openpty(&master, &slave, nullptr, nullptr, nullptr), 0);
    tcgetattr(slave, &before);
    terminal = slave;
    pid = fork();
    if (pid == 0) {
      login_tty(slave);
      execv(argv[0], argv.data());
      _exit(127);
    }
    fcntl(master, F_SETFL, O_NONBLOCK);
    loop->watch(master, [this] {
      char buffer[1000];
      const ssize_t got = read(master, buffer, sizeof buffer);
      if (got > 0) shown.append(buffer, static_cast<std::size_t>(got));
    });
    ASSERT_TRUE(until([&] { return !status.name.empty(); })) << shown;
  }
  ~OnTerminal() override {
    if (pid > 0) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
    }
    close(master);
    close(terminal);
  }
  void type(const std::string& keys) { ASSERT_EQ(write(keys), static_cast<ssize_t>(keys.size())); }
  ssize_t write(const std::string& keys) const { return ::write(master, keys.data(), keys.size()); }
  using PlayerProcess::write;
  int ended() {
    int state = 0;
    if (!until([&] { return waitpid(pid, &state, WNOHANG) == pid; })) return -1;
    pid = -1;
    return WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
  }
  bool restored() const {
    termios now{};
    return tcgetattr(terminal, &now) == 0 && now.c_lflag == before.c_lflag;
  }

  int master = -1, terminal = -1;
  pid_t pid = -1;
  termios before{};
  std::string shown;
};

TEST_F(OnTerminal, KeysPauseStepSeekAndQuit) {
  write(evenly(600, 0.1));
  start({});
  ASSERT_TRUE(until([&] { return heard.size() > 2; }));
  EXPECT_FALSE(restored());
  type(" ");
  ASSERT_TRUE(until([&] { return status.state == "paused"; }));
  listen(100ms);
  const auto stepped = [&](const std::string& keys) {
    const std::size_t count = heard.size();
    type(keys);
    if (!until([&] { return heard.size() > count; })) throw std::runtime_error("no event after " + keys);
    listen(150ms);
    EXPECT_EQ(heard.size(), count + 1);
    return heard.back().seconds;
  };
  const double here = stepped(".");
  EXPECT_NEAR(stepped("."), here + 0.1, 1e-9);
  EXPECT_NEAR(stepped("30.05g."), 30.1, 1e-9);
  EXPECT_NEAR(stepped("\x1b[C."), 35.1, 0.15);
  EXPECT_NEAR(stepped("\x1b[D\x1b[D."), 25.2, 0.35);
  type("50x ");
  ASSERT_TRUE(until([&] { return heard.back().seconds > 40; }));
  type("q");
  EXPECT_EQ(ended(), 0);
  EXPECT_TRUE(restored());
  EXPECT_THAT(shown, HasSubstr("keys: space pause"));
  EXPECT_THAT(shown, HasSubstr("paused"));
  EXPECT_THAT(shown, HasSubstr("playing x 50"));
}

TEST_F(OnTerminal, SignalsLeaveTheTerminalAsItWas) {
  write(evenly(600, 0.1));
  for (const int signal : {SIGTERM, SIGINT}) {
    status = {};
    start({});
    ASSERT_TRUE(until([&] { return !restored(); }));
    kill(pid, signal);
    EXPECT_EQ(ended(), 0);
    EXPECT_TRUE(restored());
    loop->unwatch(master);
    close(master);
    close(terminal);
  }
  master = terminal = -1;
}

}  // namespace
}  // namespace egocal

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (!::testing::GTEST_FLAG(list_tests) && !egocal::test::enter_network_namespace()) return 1;
  // a test started by hand must not read the keys of its terminal as the player's
  if (!std::freopen("/dev/null", "r", stdin)) return 1;
  return RUN_ALL_TESTS();
}
