// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The clock of a sender that jumps, repeats itself or counts in another unit is named; what networks and
// players do to good stamps is not.
#include "egocal/bus/stream_clock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace egocal::bus::test_stream_clock {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t second = 1'000'000;

/// A drive of ten seconds at 20 Hz, one message a row.
std::vector<Stamp> drive(bool numbered = true) {
  std::vector<Stamp> stamps;
  for (int i = 0; i < 200; ++i) {
    const std::int64_t t = i * second / 20;
    stamps.push_back({1'600'000'000 * second + t, 5 * second + t, numbered ? i : -1, {0.1 * i, 0, 0}});
  }
  return stamps;
}

std::vector<Stamp> changed(std::vector<Stamp> stamps, const std::function<void(int, Stamp&)>& change) {
  for (int i = 0; i < static_cast<int>(stamps.size()); ++i) change(i, stamps[static_cast<std::size_t>(i)]);
  return stamps;
}

std::vector<ClockFault> faults(const std::vector<Stamp>& stamps) {
  StreamClock clock;
  std::vector<ClockFault> all;
  for (const Stamp& stamp : stamps)
    if (const auto fault = clock.hear(stamp)) all.push_back(*fault);
  return all;
}

std::vector<std::string> reasons(const std::vector<Stamp>& stamps) {
  std::vector<std::string> all;
  for (const ClockFault& fault : faults(stamps)) all.push_back(fault.reason + ": " + fault.cure);
  return all;
}

TEST(StreamClock, AJumpIsNamedOnceWithItsSize) {
  for (const bool numbered : {true, false}) {
    const auto jumps_by = [&](std::int64_t us) {
      return reasons(changed(drive(numbered), [us](int i, Stamp& s) { s.time_us += i < 100 ? 0 : us; }));
    };
    EXPECT_THAT(jumps_by(-2 * second), ElementsAre(HasSubstr("clock jumps: its time went back by 2.0 s")));
    EXPECT_THAT(jumps_by(-second / 3), ElementsAre(HasSubstr("clock jumps: its time went back by 0.3 s")));
    EXPECT_THAT(jumps_by(3600 * second),
                ElementsAre(HasSubstr("clock jumps: its time jumped ahead by 3600 s")));
    EXPECT_THAT(jumps_by(0), IsEmpty());
  }
}

TEST(StreamClock, EachOfSeveralJumpsCounts) {
  const auto there_and_back =
      changed(drive(), [](int i, Stamp& s) { s.time_us += i >= 60 && i < 120 ? 3600 * second : 0; });
  EXPECT_THAT(reasons(there_and_back),
              ElementsAre(HasSubstr("ahead by 3600 s"), HasSubstr("back by 3600 s")));
}

TEST(StreamClock, RepeatedStampsAreNamed) {
  // a clock that ticks at 10 Hz under 20 Hz
  const auto coarse = changed(drive(), [](int, Stamp& s) { s.time_us -= s.time_us % (second / 10); });
  const auto found = reasons(coarse);
  ASSERT_EQ(found.size(), 96u);  // from the fifth on
  EXPECT_THAT(found.front(),
              HasSubstr("the same time again: several messages have one time, such as 1600000000"));
  const auto standing = reasons(changed(drive(), [](int, Stamp& s) { s.time_us = 7; }));
  ASSERT_FALSE(standing.empty());
  EXPECT_THAT(standing.front(), HasSubstr("the time does not advance: 7 us"));
}

TEST(StreamClock, AWrongUnitIsNoJump) {
  for (const auto& [factor, unit] :
       std::map<double, std::string>{{1e3, "nanoseconds?"}, {1e-3, "milliseconds?"}}) {
    const double by = factor;
    const auto found = reasons(changed(
        drive(), [by](int i, Stamp& s) { s.time_us = static_cast<std::int64_t>(1e9 + by * 50'000 * i); }));
    EXPECT_THAT(found, ::testing::Each(HasSubstr("unit of time"))) << factor;
    EXPECT_THAT(found, ::testing::Contains(HasSubstr(unit))) << factor;
  }
}

TEST(StreamClock, WhatTheNetworkDoesIsNoFault) {
  for (const bool numbered : {true, false}) {
    std::vector<Stamp> copied, overtaken = drive(numbered);
    for (const Stamp& stamp : drive(numbered)) {
      copied.push_back(stamp);
      copied.push_back(stamp);
    }
    EXPECT_THAT(reasons(copied), IsEmpty());
    for (std::size_t i = 10; i + 2 < overtaken.size(); i += 10) std::swap(overtaken[i], overtaken[i + 2]);
    EXPECT_THAT(reasons(overtaken), IsEmpty());
    // nothing gets through for three seconds, then all at once
    const auto stalled = changed(drive(numbered), [](int i, Stamp& s) {
      if (i >= 60 && i < 120) s.mono_us = 5 * second + 120 * second / 20;
    });
    EXPECT_THAT(reasons(stalled), IsEmpty());
    // of those the first comes, and the rest is lost
    std::vector<Stamp> lost = stalled;
    lost.erase(lost.begin() + 61, lost.begin() + 120);
    EXPECT_THAT(reasons(lost), IsEmpty());
    // a gap
    std::vector<Stamp> gap = drive(numbered);
    gap.erase(gap.begin() + 50, gap.begin() + 150);
    EXPECT_THAT(reasons(gap), IsEmpty());
    // one damaged stamp
    const auto damaged =
        changed(drive(numbered), [](int i, Stamp& s) { s.time_us += i == 99 ? 3600 * second : 0; });
    EXPECT_THAT(reasons(damaged), IsEmpty());
  }
}

TEST(StreamClock, WhatAPlayerDoesIsNoFault) {
  for (const bool numbered : {true, false}) {
    // 64 messages again, and again
    std::vector<Stamp> again = drive(numbered);
    const std::vector<Stamp> part(again.begin() + 36, again.begin() + 100);
    again.insert(again.begin() + 100, part.begin(), part.end());
    again.insert(again.begin() + 100, part.begin(), part.end());
    EXPECT_THAT(reasons(again), IsEmpty());
    // any speed, and gaps of the log on the way
    for (const double speed : {0.1, 1.5, 10.0, 1000.0}) {
      std::vector<Stamp> fast = changed(drive(numbered), [speed](int i, Stamp& s) {
        s.mono_us = 5 * second + static_cast<std::int64_t>(50'000 * i / speed);
      });
      EXPECT_THAT(reasons(fast), IsEmpty()) << speed;
      for (std::size_t i = 100; i < fast.size(); ++i) fast[i].time_us += 60 * second;
      EXPECT_THAT(reasons(fast), IsEmpty()) << speed;
    }
  }
  // the log from its start, and of another recording
  std::vector<Stamp> twice = drive();
  for (Stamp stamp : drive()) {
    stamp.mono_us += 10 * second;
    stamp.time_us -= 1000 * second;
    twice.push_back(stamp);
  }
  EXPECT_THAT(reasons(twice), IsEmpty());
}

}  // namespace
}  // namespace egocal::bus::test_stream_clock
