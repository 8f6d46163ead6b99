// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "egocal/bus/convert.hpp"
#include "player/in_flight.hpp"

namespace egocal::services::test_in_flight {
namespace {

bus::LogEvent event(const std::string& channel, std::int64_t step) {
  StampedPose pose;
  pose.time_us = 1'700'000'000'000'000 + 100'000 * step;
  return {step, pose.time_us, channel, bus::encode(bus::to_message(pose, step))};
}

status_t status(std::int64_t run, const std::vector<std::pair<std::string, std::int64_t>>& channels) {
  status_t message{};
  message.run = run;
  for (const auto& [channel, step] : channels) {
    message.acknowledgements.emplace_back();
    message.acknowledgements.back().channel = channel;
    message.acknowledgements.back().utime = 1'700'000'000'000'000 + 100'000 * step;
    message.acknowledgements.back().count = step + 1;
  }
  return message;
}

TEST(InFlight, ForgedChannelsTakeNoMemoryAndDisplaceNoTrueOnes) {
  InFlight in_flight;
  in_flight.acknowledged(status(1, {{"LIDAR", -1}}));
  in_flight.sent(event("LIDAR", 0));
  for (int i = 0; i < 5000; ++i) {
    std::vector<std::pair<std::string, std::int64_t>> forged;
    for (int k = 0; k < 100; ++k) forged.emplace_back("FORGED_" + std::to_string(100 * i + k), 0);
    in_flight.acknowledged(status(1, forged));
  }
  EXPECT_LE(in_flight.channels(), 256u);
  // one that nothing was sent on yet comes back with the next true status
  in_flight.acknowledged(status(1, {{"LIDAR", -1}, {"CAMERA", -1}}));
  in_flight.sent(event("LIDAR", 1));
  in_flight.sent(event("CAMERA", 1));
  EXPECT_EQ(in_flight.count(), 3u);
  EXPECT_TRUE(in_flight.acknowledged(status(1, {{"LIDAR", 1}, {"CAMERA", 1}})).any);
  EXPECT_EQ(in_flight.count(), 0u);
}

TEST(InFlight, WhatFollowsInTheLogIsStatedAfterTwoAttempts) {
  InFlight in_flight;
  in_flight.acknowledged(status(1, {{"LIDAR", -1}}));
  for (const std::int64_t step : {0, 1, 3, 2, 5}) in_flight.sent(event("LIDAR", step));
  const auto held_back_after = [&](std::int64_t step, std::int64_t received) {
    status_t message = status(1, {{"LIDAR", step}});
    message.acknowledgements[0].count = received;
    message.counters.resize(1);
    message.counters[0].name = "held back: LIDAR";
    message.counters[0].value = 1;
    return in_flight.acknowledged(message).send_again;
  };
  EXPECT_TRUE(held_back_after(1, 4));
  EXPECT_TRUE(in_flight.following().empty()) << "more of the log may still fill the gap";
  EXPECT_TRUE(held_back_after(1, 7));
  ASSERT_EQ(in_flight.following().size(), 1u);
  EXPECT_EQ(in_flight.following()[0].channel, "LIDAR");
  EXPECT_EQ(in_flight.following()[0].utime, event("LIDAR", 2).time_us) << "logged behind number 3";
  EXPECT_FALSE(held_back_after(1, 10)) << "later ones wait";
  EXPECT_EQ(in_flight.following().size(), 1u);
  EXPECT_TRUE(held_back_after(3, 12));
  EXPECT_TRUE(in_flight.following().empty()) << "the next gap";
  EXPECT_FALSE(in_flight.acknowledged(status(1, {{"LIDAR", 5}})).send_again);
  EXPECT_TRUE(in_flight.following().empty());
}

// egocal_simulation, seed 10692090: the first 23 messages were lost, and pairing took the next for the
// beginning
TEST(InFlight, AChannelBeginsWithOneMessageUntilItIsAcknowledged) {
  InFlight in_flight;
  EXPECT_FALSE(in_flight.begins("LIDAR"));
  status_t nothing = status(1, {{"LIDAR", 0}});
  nothing.acknowledgements[0].utime = 0;
  in_flight.acknowledged(nothing);
  EXPECT_FALSE(in_flight.begins("LIDAR"));
  in_flight.sent(event("LIDAR", 0));
  in_flight.sent(event("OTHER", 0));
  EXPECT_TRUE(in_flight.begins("LIDAR"));
  EXPECT_FALSE(in_flight.begins("OTHER")) << "pairing does not listen to it";
  EXPECT_FALSE(in_flight.acknowledged(status(1, {{"LIDAR", 0}})).send_again);
  EXPECT_FALSE(in_flight.begins("LIDAR"));
  for (const std::int64_t step : {1, 2, 3}) in_flight.sent(event("LIDAR", step));
  EXPECT_EQ(in_flight.all().size(), 3u);
  // a new process that has nothing
  nothing.run = 2;
  EXPECT_TRUE(in_flight.acknowledged(nothing).send_again);
  EXPECT_TRUE(in_flight.begins("LIDAR"));
  EXPECT_EQ(in_flight.all().size(), 1u);
  EXPECT_TRUE(in_flight.acknowledged(status(2, {{"LIDAR", 1}})).send_again);
  EXPECT_EQ(in_flight.all().size(), 2u);
  // and one that continues
  EXPECT_TRUE(in_flight.acknowledged(status(3, {{"LIDAR", 1}})).send_again);
  EXPECT_FALSE(in_flight.begins("LIDAR"));
  EXPECT_EQ(in_flight.all().size(), 2u);
}

}  // namespace
}  // namespace egocal::services::test_in_flight
