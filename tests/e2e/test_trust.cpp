// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Messages of other programs, sent by mistake or without end, are counted and harm nothing else.
#include <atomic>
#include <thread>

#include "processes.hpp"

namespace egocal::test_trust {
namespace {

using namespace std::chrono_literals;
using test::bin;
using test::ChildProcess;
using test::drive;
using test::Event;
using test::events;
using test::Processes;

class Trust : public Processes {
 protected:
  void send(const std::string& verb, std::int64_t session, const std::string& a = "",
            const std::string& b = "") {
    command_t command{};
    command.to = "*";
    command.verb = verb;
    command.session = session;
    command.sensor_a = a;
    command.sensor_b = b;
    loop->publish(bus::command_channel, command);
  }
  bool counted(const std::string& process, const std::string& name, std::int64_t least = 1) {
    return until([&] { return counter(process, name) >= least; });
  }
  long memory_kb(const std::string& process) const {
    std::ifstream in("/proc/" + std::to_string(processes.at(process).pid()) + "/status");
    std::string line;
    while (std::getline(in, line))
      if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
    return -1;
  }
};

TEST_F(Trust, CommandsAreForTheNamedSessionAndPairOnly) {
  start("egocal-pairing");
  start("egocal-fast");
  start("egocal-global");
  play(events(drive(100)));
  ASSERT_TRUE(until([&] { return problem && problem->matched == 99; }));
  ASSERT_TRUE(answered("egocal-fast"));
  const std::int64_t session = problem->session;
  const std::string not_meant = "rejected: command for another session or pair";
  send("reset", session + 1);
  for (const std::string process : {"egocal-pairing", "egocal-fast", "egocal-global"})
    EXPECT_TRUE(counted(process, not_meant)) << process;
  send("pause", 0, "left", "top");
  for (const std::string process : {"egocal-pairing", "egocal-fast", "egocal-global"})
    EXPECT_TRUE(counted(process, not_meant, 2)) << process;
  send("explode", 0);
  for (const std::string process : {"egocal-pairing", "egocal-fast", "egocal-global"})
    EXPECT_TRUE(counted(process, "rejected: command not understood")) << process;
  EXPECT_EQ(problem->session, session);
  EXPECT_EQ(statuses["egocal-fast"].state, "running");
  send("pause", 0, "left", "right");
  EXPECT_TRUE(until([&] { return statuses["egocal-fast"].state == "paused"; }));
  send("resume", 0);
  EXPECT_TRUE(until([&] { return statuses["egocal-fast"].state == "running"; }));
}

TEST_F(Trust, UnknownSessionsVersionsAndTypesAreCounted) {
  start("egocal-pairing");
  start("egocal-fast");
  play(events(drive(100)));
  ASSERT_TRUE(answered("egocal-fast"));
  calibration_t stray = answers["egocal-fast"];
  stray.session += 1;
  stray.solver = "stray";
  loop->publish(bus::calibration_channel("left", "right"), stray);
  EXPECT_TRUE(counted("egocal-fast", "rejected: answer of another session"));
  status_t status = statuses["egocal-pairing"];
  status.name = "old-monitor";
  status.role = "monitor";
  status.version = "0.0.1";
  status.run = 17;
  loop->publish(bus::status_channel, status);
  EXPECT_TRUE(counted("egocal-fast", "other versions heard"));
  loop->publish(bus::status_channel, bus::to_message(StampedPose{}, 0));
  EXPECT_TRUE(counted("egocal-fast", "rejected: not decodable on EGOCAL_STATUS"));
  problem_t foreign = *problem;
  foreign.sensor_b = "top";
  foreign.seq += 1;
  loop->publish(bus::problem_channel("left", "right"), foreign);
  EXPECT_TRUE(counted("egocal-fast", "rejected: sensors of another pair"));
}

TEST_F(Trust, TwoSolversOfOneNameBothGoOnAndSaySo) {
  start("egocal-pairing");
  start("egocal-fast");
  processes.emplace(
      "second", ChildProcess({bin + "/egocal-fast", "--method", "slsqp", "--rig", rig_file, "--lcm-url", url},
                             folder / "second.log"));
  std::set<std::string> methods;
  ASSERT_TRUE(until([&] {
    return statuses["egocal-fast"].last_error.find("a second process has this name") != std::string::npos;
  }));
  play(events(drive(300)));
  EXPECT_TRUE(until([&] {
    if (answers.contains("egocal-fast")) methods.insert(answers["egocal-fast"].method);
    return methods.size() == 2;
  }));
}

/// A foreign program sends without end on one channel after the other, garbage and what looks like ours,
/// large and small. A third sensor is flooded, not one of the pair that is watched.
TEST_F(Trust, AFloodOnAnyChannelStopsNothingElseAndTakesNoMemory) {
  write_rig("egocal.odometry_t",
            "[[sensor]]\nname = \"third\"\nchannel = \"ODO_THIRD\"\n[[pair]]\na = \"left\"\nb = "
            "\"third\"\n");
  start("egocal-pairing");
  start("egocal-fast");
  start("egocal-global");
  const auto all = events(drive(1200));
  play({all.begin(), all.begin() + 200});
  ASSERT_TRUE(answered("egocal-fast"));

  status_t status = statuses["egocal-pairing"];
  status.role = "monitor";
  calibration_t answer = answers["egocal-fast"];
  answer.solver = "unknown";
  command_t command{};
  command.to = "*";
  command.verb = "nonsense";
  problem_t old = *problem;
  old.sensor_b = "third";
  const std::vector<std::byte> garbage(50'000, std::byte{0x5a});
  const std::vector<std::pair<std::string, std::vector<std::byte>>> floods = {
      {"ODO_THIRD", garbage},
      {"ODO_THIRD", bus::encode(bus::to_message(all[0].pose, 0))},
      {"EGOCAL_MOTION_left_right", garbage},
      {bus::problem_channel("left", "third"), bus::encode(old)},
      {bus::calibration_channel("left", "right"), bus::encode(answer)},
      {bus::calibration_channel("left", "right"), garbage},
      {bus::status_channel, bus::encode(status)},
      {bus::status_channel, garbage},
      {bus::command_channel, bus::encode(command)},
      {"SOMETHING_ELSE", garbage},
  };
  std::map<std::string, long> before;
  std::size_t next = 200;
  for (std::size_t k = 0; k < floods.size(); ++k) {
    const auto& [channel, bytes] = floods[k];
    std::atomic<bool> over = false;
    std::atomic<std::int64_t> sent = 0;
    std::thread flood([&, channel = channel, bytes = bytes]() mutable {
      lcm::LCM bus(url);
      for (std::uint32_t i = 0; !over; ++i) {
        // names and runs of ever new processes, where the message has them
        if (channel == bus::status_channel && bytes.size() < 10'000) {
          status.name = "process" + std::to_string(i);
          status.run = i;
          bytes = bus::encode(status);
        }
        bus.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
        ++sent;
        if (i % 16 == 15) std::this_thread::sleep_for(200us);  // so that the test's machine keeps breathing
      }
    });
    for (const std::size_t end = next + 200; next < end; next += 20) {
      play({all.begin() + static_cast<std::ptrdiff_t>(next),
            all.begin() + static_cast<std::ptrdiff_t>(next + 20)});
      until([] { return false; }, 40ms);
    }
    const auto matched = static_cast<std::int64_t>(next / 2 - 1);
    EXPECT_TRUE(until([&] { return problem->matched == matched; }))
        << channel << ": " << problem->matched << " of " << matched;
    EXPECT_TRUE(answered("egocal-fast")) << channel;
    EXPECT_TRUE(until([&] { return sent > 1000; })) << channel;
    over = true;
    flood.join();
    std::printf("%s: %lld messages of %zu bytes\n", channel.c_str(), static_cast<long long>(sent),
                floods[k].second.size());
    for (const std::string process : {"egocal-pairing", "egocal-fast", "egocal-global"}) {
      if (k == 1) before[process] = memory_kb(process);
      if (k <= 1) continue;
      EXPECT_LT(memory_kb(process), before[process] + 20'000) << process << " after a flood on " << channel;
    }
  }
  EXPECT_LT(memory_kb("egocal-pairing"), 150'000);
  play({all.begin() + static_cast<std::ptrdiff_t>(next), all.end()});
  ASSERT_TRUE(until([&] { return problem->matched == 1199; }));
  expect_statistics(offline(drive(1200)));
  EXPECT_GT(counter("egocal-pairing", "rejected: not decodable on ODO_THIRD"), 100);
}

}  // namespace
}  // namespace egocal::test_trust
