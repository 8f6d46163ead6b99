// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Statuses in, plain data out: processes that come, go, and compute.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "egocal/monitor/lines.hpp"
#include "egocal/monitor/model.hpp"
#include "pair_drive.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_model_processes {
namespace {

using test::PairDrive;
using test::status_of;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ModelEvents, ProcessGoneBackRestartedEnded) {
  PairDrive drive;
  status_t status = status_of("egocal-fast", "fast", 1);
  drive.heartbeat(status);
  drive.run(20);
  EXPECT_TRUE(drive.model.processes()[0].alive);
  drive.run(20);
  EXPECT_FALSE(drive.model.processes()[0].alive);
  drive.heartbeat(status);
  status.run = 2;
  drive.heartbeat(status);
  status.state = "paused";
  status.last_error = "no global solver";
  drive.heartbeat(status);
  status.state = "ended";
  drive.heartbeat(status);
  EXPECT_FALSE(drive.model.processes()[0].alive);
  drive.run(50);
  std::vector<std::string> about;
  for (const std::string& text : drive.texts())
    if (text.starts_with("egocal-fast: ")) about.push_back(text.substr(13));
  EXPECT_THAT(about, ElementsAre("process is there (running)", "process is gone: no heartbeat for 3 s",
                                 "process is back", "process was restarted", "changed from running to paused",
                                 "no global solver", "changed from paused to ended"));
}

// A diagnosis of a drive that contradicts itself, on a core that others take, may compute for longer than 3
// s.
TEST(ModelEvents, AProcessThatComputesAsItHasAnnouncedIsNotGone) {
  PairDrive drive;
  status_t status = status_of("egocal-diagnosis", "diagnosis", 1);
  drive.heartbeat(status);
  counter_t& announced = status.counters.emplace_back();
  announced.name = bus::announced_silence_counter;
  announced.value = 20;
  status.n_counters = static_cast<std::int32_t>(status.counters.size());
  drive.heartbeat(status);
  drive.run(20);
  EXPECT_FALSE(drive.model.processes()[0].computes) << "others are silent for so long, too";
  drive.run(100);
  EXPECT_TRUE(drive.model.processes()[0].alive);
  EXPECT_TRUE(drive.model.processes()[0].computes);
  EXPECT_THAT(text_lines(drive.model, Charset::ascii), HasSubstr("egocal-diagnosis: computes, pid"));
  drive.run(100);
  EXPECT_FALSE(drive.model.processes()[0].alive) << "it was silent for longer than it has announced";
  EXPECT_FALSE(drive.model.processes()[0].computes);
  EXPECT_THAT(drive.texts(), Contains("egocal-diagnosis: process is gone: no heartbeat for 20 s"));
  drive.heartbeat(status);
  status.counters.pop_back();
  status.n_counters = static_cast<std::int32_t>(status.counters.size());
  drive.heartbeat(status);
  drive.run(40);
  EXPECT_FALSE(drive.model.processes()[0].alive) << "its computation was over";
}

// A clock that is set back between a death and the restart gives the new run the smaller number.
TEST(ModelEvents, ASecondProcessIsOneThatIsHeardBesideTheFirst) {
  PairDrive drive;
  status_t first = status_of("egocal-fast", "fast", 1), second = first;
  first.run = 100;
  second.run = 50;
  second.pid = first.pid + 1;
  drive.heartbeat(first);
  drive.heartbeat(second);
  drive.heartbeat(second);
  EXPECT_THAT(drive.fresh(),
              ElementsAre("egocal-fast: process is there (running)", "egocal-fast: process was restarted"));
  drive.heartbeat(first);
  EXPECT_THAT(drive.fresh(), ElementsAre("egocal-fast: a second process of this name is running"));
}

TEST(ModelEvents, ThisProcessIsThereWithoutANetwork) {
  PairDrive drive;
  ModelOptions options;
  options.own_host = "car";
  options.own_pid = 7;
  drive.model = Model(options);
  status_t own = status_of("egocal-monitor", "monitor", 1), other = own;
  own.host = other.host = "car";
  own.pid = 7;
  other.pid = 8;
  drive.heartbeat(own);
  drive.heartbeat(other);
  drive.run(40);
  ASSERT_EQ(drive.model.processes().size(), 2u);
  EXPECT_TRUE(drive.model.processes()[0].alive);
  EXPECT_EQ(drive.model.processes()[0].at.mono_us, drive.model.now().mono_us);
  EXPECT_FALSE(drive.model.processes()[1].alive);
}

TEST(ModelProcesses, CountsAndRates) {
  PairDrive drive;
  status_t status = status_of("egocal-pairing", "pairing", 100);
  const auto count = [&](const char* name, std::int64_t value) {
    counter_t& counter = status.counters.emplace_back();
    counter.name = name;
    counter.value = value;
  };
  count("lost", 3);
  count("rejected: too late", 4);
  count("rejected: duplicate", 5);
  drive.heartbeat(status);
  const ProcessState& process = drive.model.processes()[0];
  EXPECT_EQ(process.lost, 3);
  EXPECT_EQ(process.rejected, 9);
  EXPECT_LT(process.rate_in, 0) << "not known yet";
  drive.step += 10;
  status.counters[0].value = 300;
  drive.heartbeat(status);
  EXPECT_NEAR(process.rate_in, 200, 1e-9);
  status.run = 2;  // restarted: counts begin at zero
  status.counters[0].value = 5;
  drive.step += 10;
  drive.heartbeat(status);
  EXPECT_LT(process.rate_in, 0);
}

}  // namespace
}  // namespace egocal::monitor::test_model_processes
