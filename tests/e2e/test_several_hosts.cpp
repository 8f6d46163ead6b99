// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Sensors, solvers and monitor on hosts of their own: network namespaces on one segment, ttl=1.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/loop.hpp"
#include "support/child_process.hpp"
#include "support/paths.hpp"
#include "support/several_hosts.hpp"

namespace egocal::test_several_hosts {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;

const std::string bin = paths::bin_dir();
constexpr int poses = 400;

class SeveralHosts : public ::testing::Test {
 protected:
  SeveralHosts() {
    folder = std::filesystem::temp_directory_path() / ("egocal-hosts-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    EXPECT_EQ(ChildProcess({bin + "/egocal", "simulate", "--out", folder / "drive.log", "--rig-out",
                            folder / "rig.toml", "--poses", std::to_string(poses), "--noise", "0.01"})
                  .wait(30s),
              0);
  }
  ~SeveralHosts() override { std::filesystem::remove_all(folder); }

  ChildProcess start(const test::SeveralHosts& hosts, int host, std::vector<std::string> arguments,
                     const std::string& output, const std::string& ttl) {
    arguments[0] = bin + "/" + arguments[0];
    arguments.insert(arguments.end(),
                     {"--rig", folder / "rig.toml", "--lcm-url", "udpm://239.255.76.67:7850?ttl=" + ttl});
    std::unique_ptr<ChildProcess> child;
    hosts.in_host(host, [&] {
      child = std::make_unique<ChildProcess>(arguments, folder / output);
      return 0;
    });
    return std::move(*child);
  }

  /// The last whole line that the monitor printed.
  nlohmann::json monitor_says(const std::string& output = "monitor.json") const {
    std::ifstream in(folder / output);
    std::string line;
    nlohmann::json last;
    while (std::getline(in, line)) {
      nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
      if (!json.is_discarded()) last = std::move(json);
    }
    return last;
  }

  bool until(const std::function<bool()>& condition, std::chrono::milliseconds timeout) const {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(50ms);
    }
    return true;
  }

  /// By its newest heartbeat.
  static int in_of_pairing(const nlohmann::json& json) {
    for (const auto& process : json["processes"])
      if (process["name"] == "egocal-pairing") return process["in"];
    return 0;
  }

  /// Everything between sensors on host 0, solvers on another and the monitor on the last one.
  void replay(int count) {
    const test::SeveralHosts hosts(count);
    const int solvers = 1, monitor_host = count - 1;
    const ChildProcess monitor =
        start(hosts, monitor_host, {"egocal-monitor", "--follow", "--json"}, "monitor.json", "1");
    const ChildProcess pairing = start(hosts, solvers, {"egocal-pairing"}, "pairing.out", "1");
    const ChildProcess fast = start(hosts, solvers, {"egocal-fast"}, "fast.out", "1");
    const ChildProcess global = start(hosts, solvers, {"egocal-global"}, "global.out", "1");
    // without a pairing for three seconds a player goes on alone
    EXPECT_TRUE(until(
        [&] {
          const nlohmann::json json = monitor_says();
          int running = 0;
          if (!json.is_null())
            for (const auto& process : json["processes"])
              running +=
                  process["role"] == "pairing" || process["role"] == "fast" || process["role"] == "global";
          return running == 3;
        },
        30s));
    ChildProcess player =
        start(hosts, 0, {"egocal-player", folder / "drive.log", "--speed", "0"}, "player.out", "1");
    EXPECT_EQ(player.wait(40s), 0);
    EXPECT_TRUE(until(
        [&] {
          const nlohmann::json json = monitor_says();
          return !json.is_null() && json["pairs"].size() == 1 && json["pairs"][0]["answer"].is_object() &&
                 json["pairs"][0]["answer"]["certified"] == true &&
                 json["pairs"][0]["answer"]["seq"] == json["pairs"][0]["seq"] &&
                 in_of_pairing(json) >= 2 * poses;
        },
        20s))
        << monitor_says().dump(1);
    const nlohmann::json json = monitor_says();
    for (const auto& process : json["processes"]) EXPECT_EQ(process["lost"], 0) << process["name"];
    EXPECT_EQ(json["pairs"][0]["answer"]["reference"], "truth");
  }

  std::filesystem::path folder;
};

TEST_F(SeveralHosts, TwoSensorsHereSolversThere) {
  replay(2);
}

TEST_F(SeveralHosts, ThreeTheMonitorOnItsOwn) {
  replay(3);
}

TEST_F(SeveralHosts, WithTheDefaultUrlNothingLeavesAHost) {
  const test::SeveralHosts hosts(2);
  const ChildProcess monitor = start(hosts, 0, {"egocal-monitor", "--follow", "--json"}, "here.json", "0");
  const ChildProcess other = start(hosts, 1, {"egocal-monitor", "--follow", "--json"}, "there.json", "0");
  const ChildProcess there = start(hosts, 1, {"egocal-pairing", "--name", "there"}, "there.out", "0");
  const ChildProcess here = start(hosts, 0, {"egocal-pairing", "--name", "here"}, "here.out", "0");
  const auto seen = [&](const std::string& by, const std::string& name) {
    const nlohmann::json json = monitor_says(by);
    return !json.is_null() && std::any_of(json["processes"].begin(), json["processes"].end(),
                                          [&](const auto& process) { return process["name"] == name; });
  };
  EXPECT_TRUE(until([&] { return seen("here.json", "here") && seen("there.json", "there"); }, 20s));
  std::this_thread::sleep_for(1200ms);  // a heartbeat of the other one, if it came through
  EXPECT_TRUE(seen("here.json", "here") && seen("there.json", "there"));
  EXPECT_FALSE(seen("here.json", "there") || seen("there.json", "here"));
}

}  // namespace
}  // namespace egocal::test_several_hosts
