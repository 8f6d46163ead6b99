// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/newest.hpp"
#include "egocal/bus/peers.hpp"
#include "egocal/error.hpp"
#include "support/virtual_time.hpp"

namespace egocal::bus::test_loop {
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

// The next one was called where it no longer was: std::bad_function_call
TEST(Loop, ACallbackOfABatchMayAddOthers) {
  Loop loop("memq://", {.handle_signals = false});
  int first = 0, next = 0, added = 0;
  std::vector<std::string> blocks;
  blocks.reserve(300);
  loop.after_batch([&](bool) {
    if (++first > 1) return;
    for (int i = 0; i < 50; ++i) loop.after_batch([&added](bool) { ++added; });
    // what was freed meanwhile is used for something else
    for (std::size_t size = 16; size <= 4096; size += 16) blocks.emplace_back(size, '\0');
  });
  loop.after_batch([&next](bool) { ++next; });
  loop.subscribe<command_t>("C", [](const command_t&, const Arrival&) {});
  for (const int expected : {0, 50}) {
    loop.publish("C", command_t{});
    loop.run_once(100ms);
    EXPECT_EQ(added, expected) << "their turn comes with the next batch";
  }
  EXPECT_EQ(first, 2);
  EXPECT_EQ(next, 2);
}

TEST(Loop, SignalsEndIt) {
  Loop loop("memq://");
  raise(SIGTERM);
  loop.run();
  EXPECT_EQ(loop.signal(), SIGTERM);
}

TEST(Loop, TimersRunInTheirTime) {
  test::VirtualClock clock;
  test::VirtualNetwork network(clock);
  Loop loop(network.transport(), clock, {.handle_signals = false});
  std::vector<std::int64_t> ticks;
  loop.every(5ms, [&] { ticks.push_back(loop.mono_us()); });
  const auto never = loop.after(10ms, [] { FAIL(); });
  loop.cancel(never);
  std::int64_t once = 0;
  loop.after(7ms, [&] { once = loop.mono_us(); });
  const std::int64_t begin = loop.mono_us();
  test::run_for(clock, {&loop}, 22ms);
  EXPECT_THAT(ticks, ::testing::ElementsAre(begin + 5000, begin + 10000, begin + 15000, begin + 20000));
  EXPECT_EQ(once, begin + 7000);
}

// What could not be sent is a state, not an end: hours of it, and the first message after it goes.
TEST(Loop, ANetworkThatIsAwayIsWaitedFor) {
  test::VirtualClock clock;
  test::VirtualNetwork network(clock);
  Loop loop(network.transport(), clock, {.handle_signals = false});
  Loop other(network.transport(), clock, {.handle_signals = false});
  std::vector<std::string> reports;
  loop.on_network([&](const std::string& error) { reports.push_back(error); });
  int heard = 0;
  other.subscribe<command_t>("C", [&](const command_t&, const Arrival&) { ++heard; });
  loop.every(1s, [&] { loop.publish("C", command_t{}); });

  test::run_for(clock, {&loop, &other}, 2500ms);
  EXPECT_EQ(heard, 2);
  network.set_away(true);
  test::run_for(clock, {&loop, &other}, 5h);
  EXPECT_EQ(heard, 2);
  EXPECT_EQ(loop.counts().not_sent, 5 * 3600);
  EXPECT_NE(loop.send_error(), "");
  EXPECT_EQ(reports.size(), 1U);
  network.set_away(false);
  test::run_for(clock, {&loop, &other}, 2s);
  EXPECT_EQ(heard, 4);
  EXPECT_THAT(reports, ::testing::ElementsAre(::testing::HasSubstr("away"), ""));
  EXPECT_EQ(loop.send_error(), "");
}

TEST(Loop, CommandsThatDoOneThingNeedTheNetwork) {
  test::VirtualClock clock;
  test::VirtualNetwork network(clock);
  network.set_away(true);
  EXPECT_THROW(Loop(network.transport(), clock, {.handle_signals = false}), Error);
  EXPECT_NO_THROW(Loop(network.transport(), clock, {.handle_signals = false, .require_network = false}));
}

TEST(Loop, AFloodOnOneChannelDisplacesNothingOnAnother) {
  test::VirtualClock clock;
  test::VirtualNetwork network(clock);
  Loop loop(network.transport(), clock, {.handle_signals = false});
  int flood = 0, calm = 0;
  loop.subscribe_prefix(
      "FLOOD_", [&](const Arrival&) { ++flood; }, 10);
  loop.subscribe<command_t>(
      "CALM", [&](const command_t&, const Arrival&) { ++calm; }, 10);
  for (int i = 0; i < 100; ++i) loop.publish("FLOOD_" + std::to_string(i), command_t{});
  loop.publish("CALM", command_t{});
  loop.run_once(0ns);
  EXPECT_EQ(flood, 10);
  EXPECT_EQ(calm, 1);
  EXPECT_EQ(loop.counts().queue_full, 90);
}

// The messages that wait may have 64 MiB: large ones of one channel left no room for any other.
TEST(Loop, AFloodOfLargeMessagesDisplacesNothingOnAnotherChannel) {
  test::VirtualClock clock;
  test::VirtualNetwork network(clock);
  Loop loop(network.transport(), clock, {.handle_signals = false});
  int flood = 0, calm = 0;
  loop.subscribe_bytes(
      "FLOOD", [&](const Arrival&) { ++flood; }, 100);
  loop.subscribe<command_t>(
      "CALM", [&](const command_t&, const Arrival&) { ++calm; }, 10);
  const std::vector<std::byte> large(std::size_t{4} << 20);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(loop.publish_bytes("FLOOD", large));
  loop.publish("CALM", command_t{});
  loop.run_once(0ns);
  EXPECT_EQ(flood, 16);
  EXPECT_EQ(calm, 1);
  EXPECT_EQ(loop.counts().queue_full, 4);
}

TEST(Loop, UndecodableChannelsAreBounded) {
  test::VirtualClock clock;
  test::VirtualNetwork network(clock);
  Loop loop(network.transport(), clock, {.handle_signals = false});
  for (int i = 0; i < 1000; ++i) loop.count_undecodable("C" + std::to_string(i));
  EXPECT_LE(loop.undecodable().size(), 65U);
  EXPECT_EQ(loop.undecodable().at("other"), 936);
}

// Two heartbeats on one virtual network: no socket, no waiting.
TEST(Heartbeat, SurvivesANetworkThatIsAwayAndSaysSoAfterwards) {
  test::VirtualClock clock;
  test::VirtualNetwork network(clock);
  Loop loop(network.transport(), clock, {.handle_signals = false, .host = "h1"});
  Loop other(network.transport(), clock, {.handle_signals = false, .host = "h2"});
  Heartbeat heartbeat(loop, {"egocal-fast", Role::fast, "1", 100}, 3s);
  Heartbeat listener(other, {"egocal-global", Role::global, "1", 200}, 3s);
  std::int64_t not_sent = 0;
  std::string host;
  listener.on_status([&](const status_t& status) {
    host = status.host;
    for (const counter_t& counter : status.counters)
      if (counter.name == "not sent") not_sent = counter.value;
  });
  test::run_for(clock, {&loop, &other}, 2s);
  EXPECT_TRUE(listener.alive(Role::fast));
  EXPECT_EQ(host, "h1");
  network.set_away(true);
  test::run_for(clock, {&loop, &other}, 1h);
  EXPECT_FALSE(listener.alive(Role::fast));
  network.set_away(false);
  test::run_for(clock, {&loop, &other}, 2s);
  EXPECT_TRUE(listener.alive(Role::fast));
  EXPECT_EQ(not_sent, 3600);
}

// After Ctrl-Z and fg of all processes none counts as gone; one that is gone afterwards is noticed.
TEST(Heartbeat, TheTimeInWhichItWasStoppedIsNoSilenceOfOthers) {
  test::VirtualClock clock;
  test::VirtualNetwork network(clock);
  Loop loop(network.transport(), clock, {.handle_signals = false, .host = "h1"});
  Loop other(network.transport(), clock, {.handle_signals = false, .host = "h2"});
  Heartbeat heartbeat(loop, {"egocal-fast", Role::fast, "1", 100}, 3s);
  Heartbeat listener(other, {"egocal-global", Role::global, "1", 200}, 3s);
  test::run_for(clock, {&loop, &other}, 5s);
  clock.advance(1h);
  EXPECT_TRUE(listener.alive(Role::fast));
  test::run_for(clock, {&other}, 500ms);
  EXPECT_TRUE(listener.alive(Role::fast));
  test::run_for(clock, {&other}, 3s);
  EXPECT_FALSE(listener.alive(Role::fast));
}

// A diagnosis that computed for longer than 3 s was shown as gone.
TEST(Heartbeat, AnnouncesThatItWillBeSilentOnce) {
  test::VirtualClock clock;
  test::VirtualNetwork network(clock);
  Loop loop(network.transport(), clock, {.handle_signals = false, .host = "h1"});
  Loop other(network.transport(), clock, {.handle_signals = false, .host = "h2"});
  Heartbeat heartbeat(loop, {"egocal-diagnosis", Role::diagnosis, "1", 100}, 3s);
  Heartbeat listener(other, {"egocal-global", Role::global, "1", 200}, 3s);
  std::vector<std::chrono::seconds> announced;
  listener.on_status([&](const status_t& status) { announced.push_back(announced_silence(status)); });
  test::run_for(clock, {&loop, &other}, 1500ms);
  announced.clear();
  heartbeat.announce_silence(20s);
  clock.advance(10s);
  test::run_for(clock, {&loop, &other}, 1ms);
  ASSERT_GE(announced.size(), 2u);
  EXPECT_EQ(announced[0], 20s);
  EXPECT_EQ(announced[1], 0s);
}

TEST(Heartbeat, ASilenceThatIsAnnouncedIsBounded) {
  status_t status{};
  EXPECT_EQ(announced_silence(status), 0s);
  counter_t& counter = status.counters.emplace_back();
  counter.name = announced_silence_counter;
  for (const auto& [value, believed] : {std::pair{std::numeric_limits<std::int64_t>::min(), 0s},
                                        {std::int64_t{-1}, 0s},
                                        {7, 7s},
                                        {60, 60s},
                                        {61, 60s},
                                        {std::numeric_limits<std::int64_t>::max(), 60s}}) {
    counter.value = value;
    EXPECT_EQ(announced_silence(status), believed) << value;
  }
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

status_t status_of(const std::string& name, const std::string& role, const std::string& state) {
  status_t status{};
  status.name = name;
  status.role = role;
  status.run = 10;
  status.state = state;
  return status;
}

TEST(Peers, AreForgottenWhenSilentEndedOrTooMany) {
  Peers peers;
  constexpr std::int64_t now = 0, timeout = 3'000'000;
  status_t status = status_of("egocal-fast", "fast", "running");
  peers.hear(status, now);
  EXPECT_TRUE(peers.alive(Role::fast, now + 1'000'000, timeout));
  EXPECT_FALSE(peers.alive(Role::fast, now + 4'000'000, timeout));
  EXPECT_FALSE(peers.alive(Role::global, now, timeout));
  status.state = "ended";
  peers.hear(status, now);
  EXPECT_FALSE(peers.alive(Role::fast, now, timeout));
  for (int i = 0; i < 1000; ++i) {
    status.run = 100 + i;
    status.name = "flood";
    peers.hear(status, now + 1000 * i);
  }
  EXPECT_EQ(peers.role_of("egocal-fast"), std::nullopt);
}

// egocal_simulation, seed 10791898: the successor waited three seconds more for a process that had ended
TEST(Peers, AStatusThatTheNetworkDelayedDoesNotReviveWhatHasEnded) {
  Peers peers;
  constexpr std::int64_t now = 0, timeout = 3'000'000;
  status_t before = status_of("egocal-pairing", "pairing", "running");
  before.utime = 1000;
  status_t last = before;
  last.state = "ended";
  last.utime = 1001;
  for (const status_t* status : {&before, &last, &before}) peers.hear(*status, now);
  EXPECT_FALSE(peers.alive(Role::pairing, now, timeout));
  before.run = 11;  // its next start
  peers.hear(before, now);
  EXPECT_TRUE(peers.alive(Role::pairing, now, timeout));
}

TEST(Peers, ANamesakeThatWorksPrecedesOneThatDoesNotWhateverTheDatesOfTheirStarts) {
  constexpr std::int64_t now = 0, timeout = 3'000'000, early = 9, late = 11;
  const auto precedes = [&](const std::string& state, std::int64_t run, State own_state) {
    Peers peers;
    status_t status = status_of("egocal-pairing", "pairing", state);
    status.host = "h";
    status.run = run;
    peers.hear(status, now);
    return peers.senior_namesake({"egocal-pairing", "h", 10, 1, own_state}, now, timeout).has_value();
  };
  for (const std::int64_t run : {early, late}) {
    EXPECT_TRUE(precedes("running", run, State::waiting));
    EXPECT_TRUE(precedes("paused", run, State::waiting));
    EXPECT_FALSE(precedes("waiting", run, State::running));
    EXPECT_FALSE(precedes("of another version", run, State::paused));
    EXPECT_FALSE(precedes("ended", run, State::waiting));
    EXPECT_EQ(precedes("waiting", run, State::waiting), run == early);
    EXPECT_EQ(precedes("running", run, State::paused), run == early);
  }
}

}  // namespace
}  // namespace egocal::bus::test_loop
