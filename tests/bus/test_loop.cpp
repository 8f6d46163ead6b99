// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <stdexcept>

#include "egocal/bus/glue.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/newest.hpp"
#include "egocal/bus/peers.hpp"
#include "egocal/error.hpp"

namespace egocal::bus {
namespace {

using namespace std::chrono_literals;

TEST(Loop, ChannelsAreNamesNotPatterns) {
  Loop loop("memq://");
  int heard = 0;
  loop.subscribe<command_t>("A.B", [&](const command_t&, const Arrival&) { ++heard; });
  loop.publish("AxB", command_t{});
  loop.publish("A.B", command_t{});
  loop.run_once(100ms);
  loop.run_once(10ms);
  EXPECT_EQ(heard, 1);
}

TEST(Loop, WhatCannotBeDecodedIsCounted) {
  Loop loop("memq://");
  int heard = 0;
  loop.subscribe<command_t>("C", [&](const command_t&, const Arrival&) { ++heard; });
  loop.publish("C", to_message(StampedPose{}, 0));
  loop.run_once(100ms);
  EXPECT_EQ(heard, 0);
  EXPECT_EQ(loop.undecodable().at("C"), 1);
}

TEST(Loop, ExceptionsOfHandlersLeaveRun) {
  Loop loop("memq://");
  loop.subscribe<command_t>("C", [](const command_t&, const Arrival&) { throw std::logic_error("mine"); });
  loop.publish("C", command_t{});
  EXPECT_THROW(loop.run(), std::logic_error);
}

TEST(Loop, SignalsEndIt) {
  Loop loop("memq://");
  raise(SIGTERM);
  loop.run();
  EXPECT_EQ(loop.signal(), SIGTERM);
}

TEST(Loop, TimersRunInTheirTime) {
  Loop loop("memq://");
  int ticks = 0;
  loop.every(5ms, [&] { ++ticks; });
  const auto never = loop.after(10ms, [] { FAIL(); });
  loop.cancel(never);
  const auto begin = std::chrono::steady_clock::now();
  loop.after(50ms, [&] { loop.stop(); });
  loop.run();
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 50ms);
  EXPECT_GE(ticks, 3);
  EXPECT_LE(ticks, 11);
}

TEST(Loop, BadUrlIsOneClearError) {
  EXPECT_THROW(Loop("nonsense://"), Error);
  EXPECT_THROW(Loop("udpm://not.an.address:1"), Error);
}

TEST(Newest, OnlyTheNewestIsKept) {
  Loop loop("memq://");
  Newest<command_t> newest(loop, "C");
  for (int i = 1; i <= 5; ++i) {
    command_t message{};
    message.utime = i;
    loop.publish("C", message);
  }
  loop.publish("C", status_t{});  // of another type: does not displace the newest
  loop.run_once(100ms);
  EXPECT_EQ(loop.undecodable().at("C"), 1);
  command_t message{};
  ASSERT_TRUE(newest.take(message));
  EXPECT_EQ(message.utime, 5);
  EXPECT_EQ(newest.skipped(), 4);
  EXPECT_FALSE(newest.take(message));
}

TEST(Peers, AreForgottenWhenSilentEndedOrTooMany) {
  Peers peers;
  const Peers::Time now{};
  status_t status{};
  status.name = "egocal-fast";
  status.role = "fast";
  status.run = 10;
  status.state = "running";
  peers.hear(status, now);
  EXPECT_TRUE(peers.alive("fast", now + 1s, 3s));
  EXPECT_FALSE(peers.alive("fast", now + 4s, 3s));
  EXPECT_FALSE(peers.alive("global", now, 3s));
  EXPECT_TRUE(peers.elder_namesake("egocal-fast", 11, "h", 1, now, 3s));
  EXPECT_FALSE(peers.elder_namesake("egocal-fast", 9, "h", 1, now, 3s));
  status.state = "ended";
  peers.hear(status, now);
  EXPECT_FALSE(peers.alive("fast", now, 3s));
  for (int i = 0; i < 1000; ++i) {
    status.run = 100 + i;
    status.name = "flood";
    peers.hear(status, now + std::chrono::milliseconds(i));
  }
  EXPECT_EQ(peers.role_of("egocal-fast"), "");
}

}  // namespace
}  // namespace egocal::bus
