// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Two pairing processes of one name: only the older one sends, from the first message on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/simulation/simulation.hpp"
#include "support/child_process.hpp"
#include "support/paths.hpp"

namespace egocal::test_namesakes {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;

constexpr const char* url = "udpm://239.255.76.67:7761?ttl=0";

class Namesakes : public ::testing::Test {
 protected:
  Namesakes()
      : folder(std::filesystem::temp_directory_path() / ("egocal_namesakes_" + std::to_string(getpid()))),
        loop(url, bus::LoopOptions{.handle_signals = false}) {
    std::filesystem::create_directories(folder);
    rig = folder / "rig.toml";
    std::ofstream(rig) << "[bus]\nurl = \"" << url
                       << "\"\n[[sensor]]\nname = \"left\"\nchannel = \"L\"\n[[sensor]]\nname = "
                          "\"right\"\nchannel = \"R\"\n[[pair]]\na = \"left\"\nb = \"right\"\n";
    SimulationOptions options;
    options.poses = 4000;
    options.T_vehicle_sensor = {Pose{}, Pose{rotation_exp({0.3, -0.2, 0.9}), {0.4, -0.8, 0.3}}};
    trajectories = simulate(options);
    loop.subscribe<problem_t>(bus::problem_channel("left", "right"),
                              [this](const problem_t& problem, const bus::Arrival&) {
                                sessions.insert(problem.session);
                                ++problems;
                              });
    loop.subscribe<status_t>(bus::status_channel, [this](const status_t& status, const bus::Arrival&) {
      if (status.role == "pairing") states[status.pid].insert(status.state);
    });
  }
  ~Namesakes() override { std::filesystem::remove_all(folder); }

  /// A live drive at 50 Hz.
  void drive(std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    drives_until([&] { return std::chrono::steady_clock::now() >= end; });
  }
  bool drives_until(const std::function<bool()>& condition) {
    while (!condition()) {
      if (next >= trajectories[0].size()) return false;
      for (std::size_t k = 0; k < 2; ++k) {
        StampedPose pose = trajectories[k][next];
        pose.time_us += 1'700'000'000'000'000;
        loop.publish(k == 0 ? "L" : "R", bus::to_message(pose, static_cast<std::int64_t>(next)));
      }
      ++next;
      const auto until = std::chrono::steady_clock::now() + 20ms;
      for (auto now = std::chrono::steady_clock::now(); now < until; now = std::chrono::steady_clock::now())
        loop.run_once(until - now);
    }
    return true;
  }
  ChildProcess pairing(const std::string& state) const {
    return ChildProcess({paths::bin_dir() + "/egocal-pairing", "--rig", rig, "--state", folder / state},
                        folder / "said");
  }

  std::filesystem::path folder, rig;
  bus::Loop loop;
  std::vector<Trajectory> trajectories;
  std::size_t next = 0, problems = 0;
  std::set<std::int64_t> sessions;
  std::map<std::int32_t, std::set<std::string>> states;
};

TEST_F(Namesakes, TheYoungerOneSendsNothingFromItsFirstMessageOn) {
  ChildProcess elder = pairing("elder.state");
  ASSERT_TRUE(drives_until([&] { return problems > 50; }));
  ASSERT_EQ(sessions.size(), 1u);
  for (int i = 0; i < 3; ++i) {
    const std::size_t before = problems;
    ChildProcess younger = pairing("younger.state");
    ASSERT_TRUE(drives_until([&] { return !states[younger.pid()].empty(); }));
    drive(1500ms);
    EXPECT_EQ(sessions.size(), 1u) << "another session was begun";
    EXPECT_EQ(states[younger.pid()], std::set<std::string>{"waiting"});
    EXPECT_GT(problems, before + 20);
    // a command changes nothing about that
    command_t command{};
    command.utime = 1'700'000'000'000'000;
    command.to = "*";
    command.verb = "resume";
    loop.publish(bus::command_channel, command);
    drive(500ms);
    EXPECT_EQ(states[younger.pid()], std::set<std::string>{"waiting"});
    younger.signal(i == 1 ? SIGKILL : SIGTERM);
    younger.wait(10s);
  }
}

TEST_F(Namesakes, APausedOneThatIsRestoredIsPausedFromItsFirstStatusOn) {
  ChildProcess first = pairing("state");
  ASSERT_TRUE(drives_until([&] { return problems > 10; }));
  command_t command{};
  command.utime = 1'700'000'000'000'000;
  command.to = "*";
  command.verb = "pause";
  loop.publish(bus::command_channel, command);
  ASSERT_TRUE(drives_until([&] { return states[first.pid()].contains("paused"); }));
  first.signal(SIGKILL);
  first.wait(10s);
  ChildProcess second = pairing("state");
  ASSERT_TRUE(drives_until([&] { return !states[second.pid()].empty(); }));
  drive(1500ms);
  EXPECT_TRUE(states[second.pid()].contains("paused"));
  EXPECT_FALSE(states[second.pid()].contains("running"));
}

}  // namespace
}  // namespace egocal::test_namesakes
