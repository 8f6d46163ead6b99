// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "egocal/bus/pair_messages.hpp"

namespace egocal::bus::test_pair_messages {
namespace {

using namespace std::chrono_literals;

template <class Message>
Message about(const std::string& a, const std::string& b) {
  Message message{};
  message.sensor_a = a;
  message.sensor_b = b;
  return message;
}

TEST(PairMessages, ThatNameAnotherPairAreNotHeard) {
  Loop loop("memq://");
  std::map<std::string, int> heard;
  subscribe_pair(loop, "lidar", "camera", [&](const auto& message, const Arrival& arrival) {
    EXPECT_EQ(channel_of(message), arrival.channel);
    EXPECT_EQ(message.sensor_a + "," + message.sensor_b, "lidar,camera");
    ++heard[arrival.channel];
  });
  const auto send = [&]<class Message>(const Message&) {
    const std::string channel = channel_of(about<Message>("lidar", "camera"));
    loop.publish(channel, about<Message>("lidar", "camera"));
    loop.publish(channel, about<Message>("lidar", "radar"));
    loop.publish(channel, about<Message>("camera", "lidar"));
    for (int i = 0; i < 10; ++i) loop.run_once(1ms);
    EXPECT_EQ(heard[channel], 1) << channel;
    EXPECT_EQ(loop.undecodable().at(channel), 2) << channel;
  };
  send(problem_t{});
  send(calibration_t{});
  send(verdict_t{});
  send(scale_problem_t{});
  send(scale_t{});
  EXPECT_EQ(heard.size(), 5u);
}

}  // namespace
}  // namespace egocal::bus::test_pair_messages
