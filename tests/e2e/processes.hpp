// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <optional>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/simulation/simulation.hpp"
#include "support/child_process.hpp"
#include "support/network_namespace.hpp"
#include "support/paths.hpp"
#include "support/steady_sender.hpp"

namespace egocal::test {

using namespace std::chrono_literals;  // NOLINT: for the tests that include this
inline const std::string bin = paths::bin_dir();

inline std::vector<Trajectory> drive(int poses, double noise = 0.01, std::uint64_t seed = 1) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = poses;
  options.relative_noise = noise;
  options.seed = seed;
  options.T_vehicle_sensor = {Pose{}, Pose{rotation_exp({0.3, -0.2, 0.9}), {0.4, -0.8, 0.3}}};
  std::vector<Trajectory> trajectories = simulate(options);
  for (Trajectory& trajectory : trajectories)
    for (StampedPose& pose : trajectory) pose.time_us += 1'600'000'000'000'000;
  return trajectories;
}

/// The two streams in the order in which they were measured.
struct Event {
  Side side;
  StampedPose pose;
  std::int64_t seq;
};
inline std::vector<Event> events(const std::vector<Trajectory>& trajectories) {
  std::vector<Event> all;
  for (const Side side : {Side::a, Side::b})
    for (std::int64_t seq = 0; const StampedPose& pose : trajectories[side == Side::a ? 0 : 1])
      all.push_back({side, pose, seq++});
  std::stable_sort(all.begin(), all.end(),
                   [](const Event& x, const Event& y) { return x.pose.time_us < y.pose.time_us; });
  return all;
}

/// Our programs on a network of their own, and an observer of all that they send.
class Processes : public ::testing::Test {
 protected:
  Processes() {
    static int port = 7700;
    url = "udpm://239.255.76.67:" + std::to_string(++port) + "?ttl=0";
    folder = std::filesystem::temp_directory_path() /
             ("egocal-e2e-" + std::to_string(getpid()) + "-" + std::to_string(port));
    std::filesystem::create_directories(folder);
    write_rig("egocal.odometry_t");
    loop = std::make_unique<bus::Loop>(url, bus::LoopOptions{.handle_signals = false});
    loop->subscribe<problem_t>(bus::problem_channel("left", "right"),
                               [this](const problem_t& m, const bus::Arrival&) { problem = m; });
    loop->subscribe<calibration_t>(
        bus::calibration_channel("left", "right"),
        [this](const calibration_t& m, const bus::Arrival&) { answers[m.solver] = m; });
    loop->subscribe<status_t>(bus::status_channel,
                              [this](const status_t& m, const bus::Arrival&) { statuses[m.name] = m; });
  }
  ~Processes() override {
    processes.clear();
    player.reset();
    loop.reset();
    std::filesystem::remove_all(folder);
  }

  void write_rig(const std::string& type, const std::string& more = "") {
    rig_file = folder / "rig.toml";
    std::ofstream(rig_file) << "[[sensor]]\nname = \"left\"\nchannel = \"ODO_LEFT\"\ntype = \"" << type
                            << "\"\n[[sensor]]\nname = \"right\"\nchannel = \"ODO_RIGHT\"\ntype = \"" << type
                            << "\"\n[[pair]]\na = \"left\"\nb = \"right\"\nstride = 1\nweights = \"equal\"\n"
                            << "[solver]\nheartbeat_timeout = 1.5\n"
                            << more;
  }

  void start(const std::string& program, std::vector<std::string> more = {}, const std::string& name = "") {
    std::vector<std::string> arguments{bin + "/" + program, "--rig", rig_file, "--lcm-url", url};
    if (!name.empty()) more.insert(more.end(), {"--name", name});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const std::string key = name.empty() ? program : name;
    statuses.erase(key);
    processes.erase(key);
    processes.emplace(key, ChildProcess(arguments, folder / (key + ".log")));
    ASSERT_TRUE(until([&] { return statuses.contains(key); })) << key << " does not send its heartbeat";
  }

  /// Generously: a busy machine is slow, not wrong.
  static constexpr std::chrono::milliseconds patience = 30s;

  bool until(const std::function<bool()>& condition, std::chrono::milliseconds timeout = patience) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      loop->run_once(5ms);
    }
    return true;
  }

  static const char* channel(Side side) { return side == Side::a ? "ODO_LEFT" : "ODO_RIGHT"; }

  std::int64_t acknowledged() const {
    std::int64_t sum = 0;
    const auto pairing = statuses.find("egocal-pairing");
    if (pairing != statuses.end())
      for (const acknowledgement_t& entry : pairing->second.acknowledgements) sum += entry.count;
    return sum;
  }

  /// Sends events in step with pairing's acknowledgements, as a player does.
  void play(const std::vector<Event>& what) {
    if (!player) player = std::make_unique<SteadySender>(*loop);
    std::size_t number = 0;
    const auto until_sender = [&](const std::function<bool()>& condition) {
      return until([&] {
        player->watch_over();
        return condition();
      });
    };
    for (const Event& event : what) {
      ASSERT_TRUE(until_sender([&] { return player->ready(); })) << "at message " << number;
      player->send(channel(event.side), bus::encode(bus::to_message(event.pose, event.seq)));
      ++number;
    }
    ASSERT_TRUE(until_sender([&] { return player->all_taken(); }));
  }

  /// Of the poses as the wire carries them, so that the statistics are the same bits.
  static Problem offline(const std::vector<Trajectory>& trajectories) {
    PairingOptions options;
    options.stride = 1;
    options.balance = Balance{};
    MotionPairing d(options);
    for (const Event& event : events(trajectories))
      d.push(event.side, *bus::to_stamped_pose(bus::to_message(event.pose, event.seq)).value);
    return d.problem();
  }

  void expect_statistics(const Problem& expected) {
    ASSERT_TRUE(problem.has_value());
    const auto received = bus::to_problem(*problem);
    ASSERT_TRUE(received) << received.reason;
    ASSERT_EQ(received.value->blocks.size(), expected.blocks.size());
    for (std::size_t i = 0; i < expected.blocks.size(); ++i) {
      EXPECT_EQ(received.value->blocks[i].count, expected.blocks[i].count);
      EXPECT_TRUE(received.value->blocks[i].dual_rows == expected.blocks[i].dual_rows) << "not the same bits";
    }
  }

  void expect_answer(const std::string& solver, const Problem& expected_problem, double tolerance = 1e-12) {
    ASSERT_TRUE(answers.contains(solver)) << "no answer of " << solver;
    const calibration_t& message = answers[solver];
    const Answer expected = solve(expected_problem, Method::dual);
    const auto T = bus::to_dual_quaternion(message.pos, message.quat);
    ASSERT_TRUE(T);
    EXPECT_EQ(message.status, 0);
    const ExtrinsicError error = extrinsic_error(expected.T_a_b, *T.value);
    EXPECT_LT(error.translation, tolerance);
    EXPECT_LT(error.rotation, tolerance);
  }

  bool answered(const std::string& solver) {
    return until([&] {
      return problem && answers.contains(solver) && answers[solver].seq == problem->seq &&
             answers[solver].session == problem->session;
    });
  }

  std::int64_t counter(const std::string& process, const std::string& name) {
    for (const counter_t& c : statuses[process].counters)
      if (c.name == name) return c.value;
    return 0;
  }

  std::string url;
  std::filesystem::path folder;
  std::string rig_file;
  std::unique_ptr<bus::Loop> loop;
  std::unique_ptr<SteadySender> player;
  std::map<std::string, ChildProcess> processes;
  std::optional<problem_t> problem;
  std::map<std::string, calibration_t> answers;
  std::map<std::string, status_t> statuses;
};

}  // namespace egocal::test
