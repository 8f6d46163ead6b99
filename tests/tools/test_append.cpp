// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Several drives one after the other: where a time is.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "offline/drives/append.hpp"

namespace egocal::tools::test_append {
namespace {

Trajectory drive(std::int64_t begin_us, int poses, double x) {
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i) {
    Pose pose;
    pose.translation.x() = x + i;
    trajectory.push_back({begin_us + std::int64_t{100'000} * i, to_dual_quaternion(pose)});
  }
  return trajectory;
}

TEST(Append, ATimeIsOfADriveOrBetweenTwo) {
  Trajectory a = drive(1'000'000, 101, 0), b = drive(1'000'000, 101, 0);
  Drives drives({&a, &b}, {"a1", "b1"});
  EXPECT_EQ(drives.place_of(3), "");
  std::vector<std::string> notes;
  drives.append({drive(7'000'000, 51, 500), drive(7'000'000, 51, 500)}, {"a2", "b2"}, notes);
  EXPECT_EQ(a.size(), 152u);
  EXPECT_EQ(drives.place_of(3), "3.0 s into a1");
  EXPECT_EQ(drives.place_of(1800), "between a1 and a2");
  EXPECT_EQ(drives.place_of(3610 + 2.5), "2.5 s into a2");
  EXPECT_EQ(drives.place_of(3700), "90.0 s into a2");
}

}  // namespace
}  // namespace egocal::tools::test_append
