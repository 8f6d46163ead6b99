// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "egocal/error.hpp"
#include "player/control.hpp"
#include "player/tape.hpp"

namespace egocal::services::test_tape {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class TapeOfLog : public ::testing::Test {
 protected:
  TapeOfLog()
      : file(std::filesystem::temp_directory_path() / ("egocal_tape_" + std::to_string(getpid()) + ".log")) {}
  ~TapeOfLog() override { std::filesystem::remove(file); }

  /// Events at these times [s], on a channel, with their place as data.
  void write(const std::vector<double>& seconds, const std::string& channel = "A") {
    bus::LogWriter log(file);
    for (std::size_t i = 0; i < seconds.size(); ++i)
      log.write(static_cast<std::int64_t>(1e6 * (1000 + seconds[i])), channel,
                std::vector<std::byte>{static_cast<std::byte>(i)});
    log.close();
  }
  static std::vector<double> rest(Tape& tape) {
    std::vector<double> seconds;
    while (const auto event = tape.next())
      seconds.push_back(std::round(1e-3 * static_cast<double>(event->time_us) - 1e6) / 1000);
    return seconds;
  }
  std::string file;
};

TEST_F(TapeOfLog, PlaysARangeAndAgain) {
  write({0, 1, 2, 3, 4, 5});
  Tape tape(file, {.start = 1, .end = 3.5, .channel = ""});
  EXPECT_THAT(rest(tape), ElementsAre(1, 2, 3));
  tape.rewind(2.5);
  EXPECT_THAT(rest(tape), ElementsAre(3));
  EXPECT_THROW(Tape(file, {.start = 9, .end = {}, .channel = ""}), Error);
}

TEST_F(TapeOfLog, AFlippedBitInATimeCausesNoWait) {
  const double years = 1e9;
  for (const auto& [times, played] : std::vector<std::pair<std::vector<double>, std::vector<double>>>{
           {{0, 1, years, 3}, {0, 1, 1, 3}},    // forwards
           {{0, 1, -900, 3}, {0, 1, 1, 3}},     // backwards
           {{years, 1, 2, 3}, {1, 1, 2, 3}},    // the first one
           {{-1e8, 1, 2, 3}, {1, 1, 2, 3}},     //
           {{0, 1, 2, years}, {0, 1, 2, 2}},    // the last one
           {{0, 1, 2, -100}, {0, 1, 2, 2}}}) {  //
    write(times);
    Tape tape(file, {});
    EXPECT_EQ(rest(tape), played);
    EXPECT_EQ(tape.damaged_times(), 1u);
  }
}

TEST_F(TapeOfLog, GapsAndClocksThatWereSetAreNoDamage) {
  for (const std::vector<double>& times : {std::vector<double>{0, 1, 5000, 5001},  // a gap
                                           std::vector<double>{500, 501, 10, 11},  // a clock set back
                                           std::vector<double>{0, 100, 200, 300},  //
                                           std::vector<double>{1, 0.5, 1.5, 1.2}}) {
    write(times);
    Tape tape(file, {});
    EXPECT_EQ(rest(tape), times);
    EXPECT_EQ(tape.damaged_times(), 0u);
  }
}

TEST_F(TapeOfLog, OwnChannelsAreLeftOutUnlessAskedFor) {
  write({0, 1, 2}, "EGOCAL_STATUS");
  try {
    Tape tape(file, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("EGOCAL_ channels are played with --channel"));
  }
  Tape asked(file, {.start = 0, .end = {}, .channel = "EGOCAL_.*"});
  EXPECT_EQ(rest(asked).size(), 3u);
  EXPECT_THROW(Tape(file, {.start = 0, .end = {}, .channel = "("}), Error);
}

std::string typed(const std::string& bytes) {
  Keys keys;
  std::string all;
  for (const char byte : bytes)
    if (const auto control = keys.feed(byte)) {
      char text[40];
      std::snprintf(text, sizeof text, "%d:%g ", static_cast<int>(control->verb), control->value);
      all += text;
    }
  return all;
}

TEST(Controls, KeysAndVerbs) {
  EXPECT_EQ(typed(" "), "2:0 ");
  EXPECT_EQ(typed(".s"), "3:0 3:0 ");
  EXPECT_EQ(typed("12.5g"), "4:12.5 ");
  EXPECT_EQ(typed("4x0x"), "6:4 6:0 ");
  EXPECT_EQ(typed("\x1b[C\x1b[D\x1bOC"), "5:5 5:-5 5:5 ");
  EXPECT_EQ(typed("+-q"), "7:2 7:0.5 8:0 ");
  EXPECT_EQ(typed("g1.2.3gzz\x1b[A\n12\n"), "");
  EXPECT_EQ(typed("9999999999999999g"), "");
  EXPECT_EQ(control_from_text("seek 12.5")->value, 12.5);
  EXPECT_EQ(control_from_text("speed 0")->value, 0);
  for (const char* text :
       {"", "seek", "seek ", "seek x", "seek -1", "seek nan", "speed inf", "speed 1e9", "quit", "reset"})
    EXPECT_FALSE(control_from_text(text)) << text;
}

}  // namespace
}  // namespace egocal::services::test_tape
