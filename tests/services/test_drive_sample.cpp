// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which poses of a session a diagnosis looks at.
#include <gtest/gtest.h>

#include <algorithm>

#include "diagnosis/drive_sample.hpp"

namespace egocal::services::test_drive_sample {
namespace {

constexpr std::int64_t start_us = 1'600'000'000'000'000;

StampedPose at(double seconds) {
  return {start_us + static_cast<std::int64_t>(1e6 * seconds), DualQuaternion{}};
}

std::int64_t longest_gap(const Trajectory& poses) {
  std::int64_t longest = 0;
  for (std::size_t i = 1; i < poses.size(); ++i)
    longest = std::max(longest, poses[i].time_us - poses[i - 1].time_us);
  return longest;
}

TEST(DriveSample, KeepsAShortDriveWhole) {
  DriveSample sample;
  for (int i = 0; i < 1000; ++i) sample.push(Side::a, at(0.1 * i));
  EXPECT_EQ(sample.poses(Side::a).size(), 1000u);
  EXPECT_TRUE(sample.poses(Side::b).empty());
}

// Motions are judged at the stamps of the slower one.
TEST(DriveSample, AFasterStreamCostsTheSlowerOneNothing) {
  DriveSample sample;
  for (int i = 0; i < 2200; ++i) {
    sample.push(Side::b, at(0.05 * i));
    if (i % 2 == 0) sample.push(Side::a, at(0.05 * i));
  }
  EXPECT_EQ(sample.poses(Side::a).size(), 1100u);
  EXPECT_EQ(sample.poses(Side::b).size(), 2200u);
}

TEST(DriveSample, AStreamAloneIsBounded) {
  const DriveSampleOptions options;
  DriveSample sample(options);
  for (int i = 0; i < 100'000; ++i) {
    sample.push(Side::a, at(0.1 * i));
    ASSERT_LE(sample.poses(Side::a).size(), options.most_poses * options.most_of_faster);
  }
}

TEST(DriveSample, SpansALongSessionInBoundedMemory) {
  const DriveSampleOptions options;
  DriveSample sample(options);
  constexpr int poses = 10 * 3600 * 10;
  for (int i = 0; i < poses; ++i) {
    sample.push(Side::a, at(0.1 * i));
    sample.push(Side::b, at(0.1 * i + 0.03));
    const std::size_t a = sample.poses(Side::a).size(), b = sample.poses(Side::b).size();
    ASSERT_LE(std::min(a, b), options.most_poses);
    ASSERT_LE(std::max(a, b), options.most_poses + 1);
  }
  for (const Side side : {Side::a, Side::b}) {
    const Trajectory& kept = sample.poses(side);
    EXPECT_GT(kept.size(), options.most_poses / 3);
    EXPECT_LT(kept.front().time_us, at(1).time_us) << "the beginning of the drive";
    EXPECT_GE(kept.back().time_us, at(0.1 * (poses - 1)).time_us) << "and its end";
    EXPECT_LT(longest_gap(kept), std::int64_t{3600} * 1'000'000) << "and the hours between";
    const auto recent = std::count_if(kept.begin(), kept.end(), [&](const StampedPose& pose) {
      return pose.time_us > kept.back().time_us - options.recent_us;
    });
    EXPECT_EQ(recent, 200) << "the newest poses are all there";
  }
}

TEST(DriveSample, KeepsTheSameTimesOfBothStreams) {
  DriveSample sample;
  sample.set_time_offset(-300);
  for (int i = 0; i < 20000; ++i) {
    sample.push(Side::a, at(0.1 * i));
    sample.push(Side::b, at(0.1 * i + 300));
  }
  const Trajectory &a = sample.poses(Side::a), &b = sample.poses(Side::b);
  std::size_t partners = 0;
  for (const StampedPose& pose : a)
    partners += static_cast<std::size_t>(std::count_if(b.begin(), b.end(), [&](const StampedPose& other) {
      return other.time_us == pose.time_us + 300'000'000;
    }));
  // one stream is a pose ahead when the sample becomes full: its stretches begin to be dropped a pose earlier
  EXPECT_GE(partners + 50, std::max(a.size(), b.size()));
}

TEST(DriveSample, SkipsPosesThatComeTooFast) {
  DriveSample sample;
  for (int i = 0; i < 10'000; ++i) sample.push(Side::a, at(0.001 * i));
  EXPECT_LE(sample.poses(Side::a).size(), 250u);
  EXPECT_GE(sample.poses(Side::a).size(), 200u);
}

TEST(DriveSample, NeverMixesTimelines) {
  DriveSample sample;
  for (int i = 0; i < 100; ++i)
    for (const Side side : {Side::a, Side::b}) sample.push(side, at(0.1 * i));
  // the log is played again: a's time runs backwards, b still sends two poses of the old timeline
  sample.begin_anew(Side::a);
  sample.push(Side::a, at(0));
  sample.push(Side::b, at(10));
  sample.begin_anew(Side::b);
  sample.push(Side::b, at(0));
  EXPECT_EQ(sample.poses(Side::a).size(), 1u);
  ASSERT_EQ(sample.poses(Side::b).size(), 1u);
  EXPECT_EQ(sample.poses(Side::b)[0].time_us, start_us);
}

TEST(DriveSample, KeepsOnlyTheNewSession) {
  DriveSample sample;
  for (int i = 0; i < 100; ++i)
    for (const Side side : {Side::a, Side::b}) sample.push(side, at(0.1 * i));
  sample.begin_session(at(5).time_us);
  for (const Side side : {Side::a, Side::b}) {
    EXPECT_EQ(sample.poses(side).size(), 50u);
    EXPECT_EQ(sample.poses(side).front().time_us, at(5).time_us);
  }
}

/// The clock of b counts from the start of a machine: all of its poses were dropped.
TEST(DriveSample, ASessionBeginsByTheClockOfA) {
  constexpr double offset = 1.5e9;
  DriveSample sample;
  for (int i = 0; i < 100; ++i) {
    sample.push(Side::a, at(0.1 * i + offset));
    sample.push(Side::b, at(0.1 * i));
  }
  sample.set_time_offset(offset);
  sample.begin_session(at(5 + offset).time_us);
  for (const Side side : {Side::a, Side::b}) EXPECT_EQ(sample.poses(side).size(), 50u);
  EXPECT_EQ(sample.poses(Side::b).front().time_us, at(5).time_us);
}

}  // namespace
}  // namespace egocal::services::test_drive_sample
