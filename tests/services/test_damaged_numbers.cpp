// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Numbered poses that are none (NaN): damaged on their way, or in the log.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <string>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/decode.hpp"
#include "pairing/accumulation.hpp"

namespace egocal::services::test_damaged_numbers {
namespace {

constexpr std::int64_t begin_us = 1'600'000'000'000'000;

class DamagedNumbers : public ::testing::Test {
 protected:
  DamagedNumbers() { accumulation.apply({Input::Kind::patient}); }

  static std::int64_t time_of(std::int64_t seq) { return begin_us + 100'000 * seq; }
  void come(std::int64_t seq, bool damaged = false) {
    StampedPose pose;
    pose.time_us = time_of(seq);
    odometry_t message = bus::to_message(pose, seq);
    if (damaged) message.pos[1] = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::byte> bytes = bus::encode(message);
    accumulation.apply({Input::Kind::message, 0, bytes});
  }
  std::int64_t count(const std::string& name) const {
    std::map<std::string, std::int64_t> counters;
    accumulation.count(counters);
    return counters[name];
  }
  std::int64_t acknowledged() const { return (accumulation.complete_until(0) - begin_us) / 100'000; }

  bus::Rig rig = bus::parse_rig(
      "[[sensor]]\nname = \"left\"\nchannel = \"L\"\n[[sensor]]\nname = \"right\"\nchannel = \"R\"\n"
      "[[pair]]\na = \"left\"\nb = \"right\"\n",
      "rig.toml");
  Accumulation accumulation{rig};
};

TEST_F(DamagedNumbers, AreWaitedForOnceAndNotAgain) {
  come(0);
  come(1, true);
  come(2);
  EXPECT_EQ(acknowledged(), 0) << "it may come whole";
  EXPECT_GT(count("held back: L"), 0);
  come(1, true);  // the player sends again
  EXPECT_EQ(acknowledged(), 2);
  EXPECT_EQ(count("held back: L"), 0);
  EXPECT_EQ(count("lost: damaged in the log"), 1);
  EXPECT_EQ(count("lost"), 0);
  come(2);
  EXPECT_EQ(count("rejected: duplicate"), 1);
}

TEST_F(DamagedNumbers, ThatWereDamagedOnTheirWayAreUsedWhenTheyComeWhole) {
  come(0);
  come(1, true);
  come(1, true);  // a copy that the network made says nothing new
  come(2);
  EXPECT_EQ(acknowledged(), 0);
  come(1);
  EXPECT_EQ(acknowledged(), 2);
  EXPECT_EQ(count("lost: damaged in the log"), 0);
  EXPECT_EQ(count("lost"), 0);
}

TEST_F(DamagedNumbers, AreNotAcknowledgedBeforeTheyCameAgain) {
  come(0);
  come(1, true);
  EXPECT_EQ(acknowledged(), 0);
  EXPECT_EQ(count("held back: L"), 1) << "asks the player to send it again";
  come(1);
  EXPECT_EQ(acknowledged(), 1);
  EXPECT_EQ(count("held back: L"), 0);
}

TEST_F(DamagedNumbers, OthersThatAreMissingBesideThemAreStillWaitedFor) {
  come(0);
  come(1, true);
  come(3, true);
  come(4);  // 2 was lost
  come(1, true);
  come(3, true);
  come(4);
  EXPECT_EQ(acknowledged(), 0);
  come(2);
  EXPECT_EQ(acknowledged(), 4);
  EXPECT_EQ(count("lost: damaged in the log"), 2);
  EXPECT_EQ(count("lost"), 0);
}

TEST_F(DamagedNumbers, AtTheEndOfTheLogAreDoneWith) {
  come(0);
  for (int i = 0; i < 3; ++i) come(1, true);
  EXPECT_EQ(acknowledged(), 1);
  EXPECT_EQ(count("held back: L"), 0);
  EXPECT_EQ(count("lost: damaged in the log"), 1);
}

TEST_F(DamagedNumbers, AreForgottenWhenTheLogBeginsAgain) {
  for (int seq = 0; seq < 50; ++seq) come(seq);
  come(50, true);
  EXPECT_EQ(acknowledged(), 49);
  for (int seq = 0; seq < 4; ++seq) {
    StampedPose pose;
    pose.time_us = begin_us - 3'600'000'000 + 100'000 * seq;
    accumulation.apply({Input::Kind::message, 0, bus::encode(bus::to_message(pose, seq))});
  }
  EXPECT_EQ(count("held back: L"), 0);
}

TEST_F(DamagedNumbers, OfALiveSensorCostTheWindowAndTakeBoundedMemory) {
  accumulation.apply({Input::Kind::impatient});
  come(0);
  come(1, true);
  for (int seq = 2; seq < 10; ++seq) come(seq);
  EXPECT_EQ(acknowledged(), 9);
  EXPECT_EQ(count("lost"), 1) << "nobody knows whether it was damaged on its way";
  for (int seq = 10; seq < 5000; ++seq) come(seq, true);
  EXPECT_LT(count("held back: L"), 300);
}

}  // namespace
}  // namespace egocal::services::test_damaged_numbers
