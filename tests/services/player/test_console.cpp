// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the player says of damage in its log.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "player/console.hpp"

namespace egocal::services::test_console {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Console, NamesDamageAsOftenAsItPromises) {
  constexpr std::uint64_t most_reported = 2;
  Console console;
  bus::LogDamage damage;
  const auto said = [&](std::uint64_t regions, std::uint64_t jumps) {
    damage.regions += regions;
    damage.jumps += jumps;
    damage.bytes += 10 * regions;
    testing::internal::CaptureStderr();
    console.say_damage(damage, most_reported);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(said(0, 0), "");
  // one read that meets several places is one line; their number counted, and left one line of two
  EXPECT_THAT(said(3, 1),
              AllOf(HasSubstr("the log is damaged here: 30 bytes"), Not(HasSubstr("more places"))));
  EXPECT_EQ(said(0, 0), "");
  EXPECT_THAT(said(1, 0), HasSubstr("the log is damaged here: 40 bytes"));
  EXPECT_THAT(said(1, 0), HasSubstr("damaged in more places"));
  EXPECT_EQ(said(0, 5), "");
  EXPECT_EQ(said(1, 0), "");
}

/// A seek skips damage, and goes back over some: neither is news.
TEST(Console, DamageThatIsTakenAsReportedIsNoNews) {
  Console console;
  bus::LogDamage damage;
  damage.regions = 7;
  console.take_as_reported(damage);
  testing::internal::CaptureStderr();
  console.say_damage(damage, 5);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  damage.regions = 8;
  testing::internal::CaptureStderr();
  console.say_damage(damage, 5);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("the log is damaged here"));
}

}  // namespace
}  // namespace egocal::services::test_console
