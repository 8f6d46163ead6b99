// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal log check` and `repair` on damaged logs, and what LCM's own player makes of the repaired ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <map>

#include "egocal/bus/loop.hpp"
#include "egocal/in_words.hpp"
#include "support/child_process.hpp"
#include "support/damaged_log.hpp"
#include "support/paths.hpp"

namespace egocal::test_log_damage {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;
using ::testing::HasSubstr;
using ::testing::Not;

class LogDamage : public ::testing::Test {
 protected:
  LogDamage()
      : folder(std::filesystem::temp_directory_path() / ("egocal_damage_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder);
    log = test::small_log(path("good.log"), 30);
  }
  ~LogDamage() override { std::filesystem::remove_all(folder); }

  std::string path(const std::string& name) const { return folder / name; }
  struct Outcome {
    int code;
    std::string said;
  };
  Outcome egocal(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), paths::bin_dir() + "/egocal");
    std::filesystem::remove(path("said"));
    const int code = ChildProcess(arguments, path("said")).wait(60s);
    return {code, test::read_bytes(path("said"))};
  }

  std::filesystem::path folder;
  test::SmallLog log;
};

TEST_F(LogDamage, CheckNamesItAndRepairLeavesALogWithoutAny) {
  testing::Random random(7);
  EXPECT_EQ(egocal({"log", "check", path("good.log")}).code, 0);
  for (int i = 0; i < 42; ++i) {
    const test::Damage damage = test::all_damages[static_cast<std::size_t>(i) % std::size(test::all_damages)];
    const test::DamagedLog damaged = test::damaged(log, damage, random);
    SCOPED_TRACE("copy " + std::to_string(i));
    if (damaged.whole.empty()) continue;
    test::write_bytes(path("damaged.log"), damaged.bytes);
    bus::LogReader reader(path("damaged.log"));
    std::vector<bus::LogEvent> events;
    while (auto event = reader.next()) events.push_back(std::move(*event));

    const Outcome check = egocal({"log", "check", path("damaged.log")});
    EXPECT_EQ(check.code, reader.damage().any() ? 1 : 0) << check.said;
    EXPECT_EQ(std::count(check.said.begin(), check.said.end(), '\n'), 1) << check.said;
    if (reader.damage().regions > 0) {
      EXPECT_THAT(check.said, HasSubstr(std::to_string(reader.damage().bytes) + " bytes and at least " +
                                        counted(reader.damage().lost_events, "event") + " lost"));
    }
    const Outcome repair = egocal({"log", "repair", path("damaged.log"), "--out", path("repaired.log")});
    ASSERT_EQ(repair.code, 0) << repair.said;
    EXPECT_THAT(repair.said, HasSubstr(std::to_string(events.size()) + " events"));
    const Outcome again = egocal({"log", "check", path("repaired.log")});
    EXPECT_EQ(again.code, 0) << again.said;
    EXPECT_THAT(again.said, HasSubstr("no damage"));
    lcm::LogFile theirs(path("repaired.log"), "r");
    for (const bus::LogEvent& mine : events) {
      const lcm::LogEvent* event = theirs.readNextEvent();
      ASSERT_NE(event, nullptr);
      EXPECT_EQ(event->channel, mine.channel);
      EXPECT_EQ(event->timestamp, mine.time_us);
      EXPECT_EQ(static_cast<std::size_t>(event->datalen), mine.data.size());
    }
    EXPECT_EQ(theirs.readNextEvent(), nullptr);
  }
}

// They said nothing: a log that was cut off or destroyed for the most part looked like a short one.
TEST_F(LogDamage, EveryAnswerOfADamagedLogWarns) {
  ASSERT_EQ(
      egocal({"simulate", "--out", path("drive.log"), "--rig-out", path("rig.toml"), "--poses", "300"}).code,
      0);
  const std::string whole = test::read_bytes(path("drive.log"));
  test::write_bytes(path("cut.log"), whole.substr(0, whole.size() * 2 / 3 + 50));
  test::write_bytes(path("noise.log"), whole.substr(0, whole.size() * 2 / 3) + std::string(20'000, '\x5a'));
  const std::vector<std::string> channels{"ODOMETRY_LIDAR", "ODOMETRY_CAMERA"};
  for (const auto& [file, lost] : {std::pair{"cut.log", "its end is cut off"}, std::pair{"noise.log", "20"}})
    for (std::vector<std::string> command : std::vector<std::vector<std::string>>{
             {"solve", channels[0], channels[1]},
             {"solve", "--rig", path("rig.toml")},
             {"check", channels[0], channels[1]},
             {"report", channels[0], channels[1], "--out", path("page.html")}}) {
      command.insert(command.end(), {"--log", path(file)});
      const Outcome run = egocal(command);
      EXPECT_THAT(run.said, HasSubstr("egocal: warning: " + path(file) + ": the log is damaged: "))
          << command[0];
      EXPECT_THAT(run.said, HasSubstr(lost)) << command[0];
      EXPECT_EQ(run.said.find("is damaged"), run.said.rfind("is damaged")) << "once: " << run.said;
    }
  EXPECT_THAT(test::read_bytes(path("page.html")), HasSubstr("the log is damaged"));
}

TEST_F(LogDamage, InfoIsJsonWhateverTheNamesAre) {
  std::string bytes = log.bytes;
  bytes[log.begin[7] + test::log_header_size + 2] ^= static_cast<char>(0x80);  // no UTF-8 any more
  test::write_bytes(path("damaged.log"), bytes);
  const Outcome info = egocal({"log", "info", "--json", path("damaged.log")});
  EXPECT_EQ(info.code, 0) << info.said;
  EXPECT_THAT(info.said, HasSubstr("\"damaged_regions\": 0"));
  EXPECT_THAT(info.said, HasSubstr("egocal.odometry_t"));
}

TEST_F(LogDamage, APipeIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  for (const std::string verb : {"info", "check"}) {
    const Outcome refused = egocal({"log", verb, path("pipe")});
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.said, HasSubstr("it is not a file"));
  }
}

TEST_F(LogDamage, RepairWritesTheWholeFileOrNone) {
  test::write_bytes(path("no.log"), "this is no log at all");
  EXPECT_EQ(egocal({"log", "repair", path("no.log"), "--out", path("out.log")}).code, 1);
  EXPECT_FALSE(std::filesystem::exists(path("out.log")));
  for (const std::string& out : {path("no/such/folder.log"), std::string("/dev/null"), path("")}) {
    const Outcome refused = egocal({"log", "repair", path("good.log"), "--out", out});
    EXPECT_EQ(refused.code, 1) << out;
    EXPECT_EQ(std::count(refused.said.begin(), refused.said.end(), '\n'), 1) << refused.said;
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));

  // a disk that is full, over a log that was there before
  test::write_bytes(path("out.log"), "the old one");
  const std::string command = "trap '' XFSZ; ulimit -f 4; exec " + paths::bin_dir() + "/egocal log repair " +
                              path("good.log") + " --out " + path("out.log");
  EXPECT_EQ(ChildProcess({"sh", "-c", command}).wait(60s), 1);
  EXPECT_EQ(test::read_bytes(path("out.log")), "the old one");
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    EXPECT_NE(entry.path().extension(), ".part");

  // in place
  test::write_bytes(path("cut.log"), log.bytes.substr(0, log.bytes.size() - 7));
  EXPECT_EQ(egocal({"log", "repair", path("cut.log"), "--out", path("cut.log")}).code, 0);
  EXPECT_EQ(test::read_bytes(path("cut.log")), log.bytes.substr(0, log.begin[log.events() - 1]));
}

TEST_F(LogDamage, LcmLogplayerPlaysARepairedLogToItsEnd) {
  test::Accident accident(log);
  accident.piece(0, log.bytes.size() - 9);
  for (const std::size_t event : {std::size_t{8}, std::size_t{20}, std::size_t{33}})
    accident.flip(log.begin[event] + 20, 7);  // the channel's length is negative
  test::write_bytes(path("damaged.log"), accident.happened().bytes);
  ASSERT_EQ(egocal({"log", "repair", path("damaged.log"), "--out", path("repaired.log")}).code, 0);

  const std::string url = "udpm://239.255.76.67:7741?ttl=0";
  bus::Loop loop(url, bus::LoopOptions{.handle_signals = false});
  std::map<std::string, std::size_t> expected, heard;
  bus::LogReader reader(path("repaired.log"));
  while (const auto event = reader.next())
    if (++expected[event->channel] == 1)
      loop.subscribe_bytes(event->channel, [&](const bus::Arrival& arrival) { ++heard[arrival.channel]; });
  EXPECT_EQ(expected["ODOMETRY_LEFT"] + expected["ODOMETRY_RIGHT_2"] + expected["EGOCAL_STATUS"],
            log.events() - 4);
  ChildProcess player({"lcm-logplayer", "--speed=10", "--lcm-url=" + url, path("repaired.log")});
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (heard != expected && std::chrono::steady_clock::now() < end) loop.run_once(5ms);
  EXPECT_EQ(heard, expected);
  EXPECT_EQ(player.wait(10s), 0);
}

}  // namespace
}  // namespace egocal::test_log_damage
