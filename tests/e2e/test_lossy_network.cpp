// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A network that loses, doubles, reorders and damages messages: still certified, and everything counted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/simulation/simulation.hpp"
#include "support/child_process.hpp"
#include "support/lossy_relay.hpp"
#include "support/paths.hpp"

namespace egocal::test_lossy_network {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;
using test::Losses;

const std::string bin = paths::bin_dir();
const Pose truth{rotation_exp({0.3, -0.2, 0.9}), {0.4, -0.8, 0.3}};

std::vector<Trajectory> drive() {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = 4000;
  options.rate = 20;  // at half of it what is lost costs more: interpolation across 0.3 s of a curve
  options.relative_noise = 0.01;
  options.T_vehicle_sensor = {Pose{}, truth};
  std::vector<Trajectory> trajectories = simulate(options);
  for (Trajectory& trajectory : trajectories)
    for (StampedPose& pose : trajectory) pose.time_us += 1'600'000'000'000'000;
  return trajectories;
}

ExtrinsicError error_of(const DualQuaternion& T) {
  return extrinsic_error(to_dual_quaternion(truth), T);
}

class LossyNetwork : public ::testing::Test {
 protected:
  LossyNetwork() {
    static int port = 7810;
    clean_url = "udpm://239.255.76.67:" + std::to_string(++port) + "?ttl=0";
    lossy_url = "udpm://239.255.76.67:" + std::to_string(++port) + "?ttl=0";
    folder = std::filesystem::temp_directory_path() / ("egocal-lossy-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    rig_file = folder / "rig.toml";
    std::ofstream(rig_file) << "[[sensor]]\nname = \"left\"\nchannel = \"L\"\n[[sensor]]\nname = "
                               "\"right\"\nchannel = \"R\"\n[[pair]]\na = \"left\"\nb = \"right\"\n";
    sensors = std::make_unique<bus::Loop>(clean_url, bus::LoopOptions{.handle_signals = false});
    relay_in = std::make_unique<bus::Loop>(clean_url, bus::LoopOptions{.handle_signals = false});
    solvers = std::make_unique<bus::Loop>(lossy_url, bus::LoopOptions{.handle_signals = false});
    solvers->subscribe<status_t>(bus::status_channel, [this](const status_t& message, const bus::Arrival&) {
      statuses[message.name] = message;
    });
    solvers->subscribe<problem_t>(
        bus::problem_channel("left", "right"),
        [this](const problem_t& message, const bus::Arrival&) { problem = message; });
    solvers->subscribe<calibration_t>(
        bus::calibration_channel("left", "right"),
        [this](const calibration_t& message, const bus::Arrival&) { answer = message; });
  }
  ~LossyNetwork() override {
    processes.clear();
    std::filesystem::remove_all(folder);
  }

  bool until(bus::Loop& loop, const std::function<bool()>& condition, std::chrono::milliseconds timeout) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      loop.run_once(5ms);
    }
    return true;
  }

  void start(const std::string& program) {
    processes.emplace_back(ChildProcess({bin + "/" + program, "--rig", rig_file, "--lcm-url", lossy_url},
                                        folder / (program + ".out")));
    ASSERT_TRUE(until(
        *solvers, [&] { return statuses.contains(program); }, 30s));
  }

  std::int64_t taken() {
    std::int64_t sum = 0;
    for (const acknowledgement_t& entry : statuses["egocal-pairing"].acknowledgements) sum += entry.count;
    return sum;
  }
  std::int64_t counter(const std::string& name) {
    for (const counter_t& entry : statuses["egocal-pairing"].counters)
      if (entry.name == name) return entry.value;
    return 0;
  }
  std::int64_t rejected() {
    std::int64_t sum = 0;
    for (const char* reason :
         {"duplicate", "too late", "time or number jumps", "not decodable on L", "not decodable on R",
          "position not finite", "position out of range", "quaternion not finite",
          "quaternion not of unit length", "time out of range", "sequence number out of range"})
      sum += counter("rejected: " + std::string(reason));
    return sum;
  }

  /// The drive through the relay, no faster than all receive it: what is lost is the relay's doing.
  test::RelayCounts play(const Losses& losses) {
    test::LossyRelay relay(losses, 7, [this](const std::string& channel, bus::Bytes bytes) {
      solvers->publish_bytes(channel, bytes);
    });
    for (const char* channel : {"L", "R"})
      relay_in->subscribe_bytes(
          channel, [&](const bus::Arrival& arrival) { relay.take(arrival.channel, arrival.bytes); }, 4096);
    const auto trajectories = drive();
    std::int64_t sent = 0;
    bool arrives = true;
    const std::size_t clean_end = trajectories[0].size() - 10;
    for (std::size_t i = 0; i < trajectories[0].size() && arrives; ++i) {
      // the last ones clean, so that nothing is still being waited for at the end
      if (i == clean_end) {
        relay.flush();
        relay.set({0, 0, 0, 0});
      }
      for (const std::size_t k : {0u, 1u}) {
        sensors->publish(k == 0 ? "L" : "R",
                         bus::to_message(trajectories[k][i], static_cast<std::int64_t>(i)));
        ++sent;
      }
      arrives = until(
                    *relay_in, [&] { return relay.counts().in == sent; }, 30s) &&
                until(
                    *solvers, [&] { return relay.counts().out - taken() < 48; }, 30s);
    }
    EXPECT_TRUE(arrives) << "the test's own network lost something";
    EXPECT_TRUE(until(
        *solvers, [&] { return taken() == relay.counts().out; }, 30s));
    EXPECT_TRUE(until(
        *solvers,
        [&] { return problem && answer && answer->seq == problem->seq && answer->utime == problem->utime; },
        30s));
    for (int i = 0; i < 2; ++i) {  // what is counted by now is in the next but one status
      statuses.erase("egocal-pairing");
      EXPECT_TRUE(until(
          *solvers, [&] { return statuses.contains("egocal-pairing"); }, 30s));
    }
    return relay.counts();
  }

  std::string clean_url, lossy_url, rig_file;
  std::filesystem::path folder;
  std::unique_ptr<bus::Loop> sensors, relay_in, solvers;
  std::vector<ChildProcess> processes;
  std::map<std::string, status_t> statuses;
  std::optional<problem_t> problem;
  std::optional<calibration_t> answer;
};

TEST_F(LossyNetwork, EveryLossIsCountedExactly) {
  start("egocal-pairing");
  start("egocal-fast");
  start("egocal-global");
  const test::RelayCounts counts = play({0.2, 0.05, 0.05, 0});
  EXPECT_GT(counts.dropped, 1000);
  EXPECT_GT(counts.doubled, 200);
  EXPECT_GT(counts.reordered, 200);
  EXPECT_EQ(counter("in"), counts.out);
  EXPECT_EQ(counter("lost"), counts.dropped);
  EXPECT_EQ(counter("rejected: duplicate"), counts.doubled);
  EXPECT_EQ(rejected(), counts.doubled);
}

TEST_F(LossyNetwork, DamagedMessagesToo) {
  start("egocal-pairing");
  start("egocal-fast");
  start("egocal-global");
  // ten times as many wrong bits as a bad network: every field is hit
  const test::RelayCounts counts = play({0.2, 0.05, 0.05, 0.01});
  EXPECT_GT(counts.flipped, 40);
  EXPECT_EQ(counter("in"), counts.out);
  // a doubled message that is damaged counts twice
  EXPECT_GE(counter("rejected: not decodable on L") + counter("rejected: not decodable on R"),
            counts.flipped_fingerprint_or_length);
  // each number that was sent is either in the statistics' stream or lost; each message that arrived is
  // either in that stream or rejected
  EXPECT_EQ(counter("lost"), counts.in - counts.out + rejected());
}

TEST_F(LossyNetwork, TheAnswerIsCertifiedAndHardlyWorse) {
  PairingOptions options;
  const auto trajectories = drive();
  const PairingResult clean = pair_motions(options, trajectories[0], trajectories[1]);
  const ExtrinsicError clean_error = error_of(solve(clean.drive.problem(), Method::dual).T_a_b);
  start("egocal-pairing");
  start("egocal-fast");
  start("egocal-global");
  play({});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 0);
  const ExtrinsicError error = error_of(*bus::to_dual_quaternion(answer->pos, answer->quat).value);
  std::printf("clean: %.2f mm %.4f deg, lossy: %.2f mm %.4f deg, %s\n", 1e3 * clean_error.translation,
              clean_error.rotation * 57.29578, 1e3 * error.translation, error.rotation * 57.29578,
              problem->choice.c_str());
  EXPECT_LT(error.translation, 2 * clean_error.translation);
  EXPECT_LT(error.rotation, 2 * clean_error.rotation);
}

}  // namespace
}  // namespace egocal::test_lossy_network
