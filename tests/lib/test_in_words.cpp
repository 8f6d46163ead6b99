// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"

namespace egocal::test_in_words {
namespace {

TEST(InWords, OneIsNoPlural) {
  EXPECT_EQ(counted(0, "pose"), "0 poses");
  EXPECT_EQ(counted(1, "pose"), "1 pose");
  EXPECT_EQ(counted(2, "pose"), "2 poses");
}

TEST(InWords, OfATrajectoryItsSpan) {
  const Trajectory two{{1'000'000, {}}, {2'500'000, {}}};
  EXPECT_EQ(span_in_words(two), "2 poses from 1.000 to 2.500 s");
  EXPECT_EQ(span_in_words(Trajectory{two[0]}), "1 pose at 1.000 s");
  EXPECT_EQ(span_in_words(Trajectory{}), "no poses");
}

TEST(InWords, OfOffsetsThatFitAsWell) {
  EXPECT_EQ(rival_offsets_in_words(4),
            "The motion repeats every 4 s: time offsets that differ by that fit as well.");
  EXPECT_EQ(rival_offsets_in_words(2.5, "radar"),
            "The motion repeats every 2.5 s: time offsets of radar that differ by that fit as well.");
}

// "a: 1 poses from 1.000 to 1.000 s"
TEST(InWords, OfStreamsThatMakeNoMotions) {
  const Trajectory two{{1'000'000, {}}, {2'500'000, {}}};
  try {
    calibrate(Trajectory{two[0]}, two);
    FAIL() << "one pose makes no motion";
  } catch (const Error& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("a: 1 pose at 1.000 s, b: 2 poses from 1.000 to 2.500 s"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace egocal::test_in_words
