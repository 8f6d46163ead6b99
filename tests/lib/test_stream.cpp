// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "../support/numbered_poses.hpp"
#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "egocal/pairing/stream.hpp"

namespace egocal::test_stream {
namespace {

using ::testing::ElementsAre;
using testing::feed;
using testing::sample;

TEST(Stream, InOrderPassesAtOnce) {
  Stream stream;
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(1, 1), sample(2, 2)}), ElementsAre(0, 1, 2));
}

TEST(Stream, SwappedMessagesAreSwappedBack) {
  Stream stream;
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(2, 2), sample(1, 1), sample(3, 3)}),
              ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(stream.counts().lost, 0);
}

TEST(Stream, ALostOneIsWaitedForByMeasuredTime) {
  Stream stream;
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(2, 2), sample(3, 3)}), ElementsAre(0));
  EXPECT_TRUE(stream.waiting());
  EXPECT_THAT(feed(stream, {sample(4, 4)}), ElementsAre(2, 3, 4));
  EXPECT_EQ(stream.counts().lost, 1);
  EXPECT_THAT(feed(stream, {sample(1, 1), sample(5, 5)}), ElementsAre(5));
  EXPECT_EQ(stream.counts().out_of_order, 1);
  EXPECT_EQ(stream.counts().lost, 0) << "it came after all";
}

TEST(Stream, FlushGivesUpWaiting) {
  Stream stream;
  feed(stream, {sample(0, 0), sample(2, 2)});
  EXPECT_EQ(stream.flush().size(), 1u);
  EXPECT_EQ(stream.counts().lost, 1);
}

TEST(Stream, DuplicatesAreCounted) {
  Stream stream;
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(1, 1), sample(1, 1), sample(0, 0), sample(2, 2)}),
              ElementsAre(0, 1, 2));
  EXPECT_EQ(stream.counts().duplicate, 2);
}

TEST(Stream, AStampThatRepeatsUnderANewNumberIsOneDuplicateAndNoLoss) {
  for (const bool patient : {false, true}) {
    Stream stream;
    stream.be_patient(patient);
    EXPECT_THAT(feed(stream, {sample(0, 0), sample(1, 1), sample(1, 2), sample(2, 3), sample(3, 4)}),
                ElementsAre(0, 1, 2, 3));
    // behind a gap, twice
    EXPECT_THAT(feed(stream, {sample(5, 6), sample(5, 7), sample(5, 8), sample(6, 9)}), ElementsAre());
    EXPECT_THAT(feed(stream, {sample(4, 5), sample(7, 10)}), ElementsAre(4, 5, 6, 7));
    EXPECT_FALSE(stream.waiting());
    EXPECT_EQ(stream.counts().duplicate, 1 + 2);
    EXPECT_EQ(stream.counts().lost + stream.counts().out_of_order + stream.counts().jump, 0);
  }
}

TEST(Stream, OneDamagedTimeOrNumberEndsNothing) {
  Stream stream;
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(1, 1), sample(-9000, 2), sample(2, 3), sample(5'000'000, 4),
                            sample(3, 5), sample(4, 1'000'000), sample(5, 6), sample(6, 7), sample(7, 8)}),
              ElementsAre(0, 1, 2, 3, 5, 6, 7));
  EXPECT_EQ(stream.counts().jump, 3);
}

TEST(Stream, ALogThatStartsAgainBeginsANewTimelineAndLosesNothing) {
  Stream stream;
  for (int i = 0; i < 100; ++i) stream.push(sample(i, i));
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(1, 1), sample(2, 2), sample(3, 3)}),
              ElementsAre(-1, 0, 1, 2, 3));
  EXPECT_EQ(stream.counts().jump, 0);
}

TEST(Stream, CopiesOfTheFirstMessagesOfALogThatStartsAgainLoseNothing) {
  for (const int copied : {0, 1}) {
    Stream stream;
    feed(stream, {sample(100, 1000), sample(101, 1001), sample(102, 1002)});
    std::vector<std::int64_t> steps;
    for (const int step : {0, 1, 2, 3})
      for (int copies = step == copied ? 2 : 1; copies > 0; --copies)
        for (const std::int64_t out : feed(stream, {sample(step, step)})) steps.push_back(out);
    EXPECT_THAT(steps, ElementsAre(-1, 0, 1, 2, 3)) << "two of message " << copied;
    EXPECT_EQ(stream.counts().duplicate, 1);
    EXPECT_EQ(stream.counts().jump, 0);
  }
}

TEST(Stream, AGapInTheLogIsNoNewTimeline) {
  Stream stream;
  feed(stream, {sample(0, -1), sample(1, -1)});
  EXPECT_THAT(feed(stream, {sample(5000, -1), sample(5001, -1), sample(5002, -1)}),
              ElementsAre(5000, 5001, 5002));
}

TEST(Stream, WhatIsMissingInAGapOfTimeIsCounted) {
  Stream stream;
  feed(stream, {sample(0, 0), sample(17, 17), sample(18, 18), sample(19, 19)});
  EXPECT_EQ(stream.counts().lost, 16) << "before a period is known";
  feed(stream, {sample(100, 100), sample(101, 101), sample(102, 102)});
  EXPECT_EQ(stream.counts().lost, 16 + 80);
  feed(stream, {sample(5000, 5000), sample(5001, 5001), sample(5002, 5002)});
  EXPECT_EQ(stream.counts().lost, 16 + 80 + 4897);
  feed(stream, {sample(5100, 900'000), sample(5101, 900'001), sample(5102, 900'002)});
  EXPECT_EQ(stream.counts().lost, 16 + 80 + 4897) << "another numbering";
}

TEST(Stream, ASourceThatCountsAnewGoesOn) {
  Stream stream;
  for (int i = 0; i < 2000; ++i) stream.push(sample(i, i));
  EXPECT_THAT(feed(stream, {sample(2000, 0), sample(2001, 1), sample(2002, 2), sample(2003, 3)}),
              ElementsAre(2000, 2001, 2002, 2003));
}

TEST(Stream, MemoryIsBounded) {
  Stream stream({.reorder_window = 1e6});
  stream.push(sample(0, 0));
  std::size_t out = 0;
  for (int i = 2; i < 5000; ++i) out += stream.push(sample(i, i)).size();
  EXPECT_GT(out, 3000u);
}

TEST(Stream, NumbersAtTheEdgeOfTheirTypeAreRefusedAndCostNoTime) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t edge : {most, most - 1, -most, limits::largest_count + 1, std::int64_t{-2}}) {
    Stream stream;
    EXPECT_THAT(feed(stream, {sample(0, edge), sample(1, 0), sample(2, 1), sample(3, edge), sample(4, 2)}),
                ElementsAre(1, 2, 4))
        << edge;
    EXPECT_EQ(stream.counts().jump, 2);
    EXPECT_LE(stream.counts().lost, 1);
  }
  Stream stream;
  NumberedPose late = sample(0, 0);
  late.pose.time_us = most;
  EXPECT_THAT(stream.push(late), ::testing::IsEmpty());
  EXPECT_THAT(feed(stream, {sample(0, limits::largest_count), sample(1, 0), sample(2, 1), sample(3, 2)}),
              ElementsAre(0, 1, 2, 3));
}

TEST(Stream, AStateThatNoStreamCanHaveIsRefused) {
  const auto refused = [](auto&& change) {
    Stream stream;
    feed(stream, {sample(0, 0), sample(1, 1), sample(3, 3)});
    StreamState state = stream.state();
    stream.restore(state);
    change(state);
    EXPECT_THROW(stream.restore(state), Error);
  };
  refused([](StreamState& state) { state.next_seq = std::numeric_limits<std::int64_t>::min(); });
  refused([](StreamState& state) { state.newest_us = std::numeric_limits<std::int64_t>::max(); });
  refused([](StreamState& state) { state.period_us = std::numeric_limits<std::int64_t>::max(); });
  refused([](StreamState& state) { state.next_seq.reset(); });
  refused([](StreamState& state) { state.recent_next = state.recent.size(); });
  refused([](StreamState& state) { state.early.begin()->second.seq = 7; });
  refused([](StreamState& state) { state.candidates.resize(1000); });
  refused([](StreamState& state) { state.going_over = true; });
}

TEST(Stream, WithALookAheadADamagedStampCostsOnlyItsOwnPose) {
  for (const bool numbered : {true, false})
    for (const std::size_t damaged : {std::size_t{0}, std::size_t{30}, std::size_t{58}, std::size_t{59}})
      for (int bit = 0; bit < 64; ++bit) {
        SCOPED_TRACE(std::to_string(damaged) + ", bit " + std::to_string(bit) + ", " +
                     (numbered ? "numbered" : "without numbers"));
        Stream stream({.look_ahead = true});
        std::vector<std::int64_t> times, expected;
        const auto take = [&times](const std::vector<NumberedPose>& out) {
          for (const NumberedPose& pose : out)
            if (times.empty() || pose.pose.time_us > times.back()) times.push_back(pose.pose.time_us);
        };
        for (std::size_t i = 0; i < 60; ++i) {
          // 50 Hz: a stamp that is less than a second off lies among others
          NumberedPose pose;
          pose.pose.time_us = 1'700'000'000'000'000 + 20'000 * static_cast<std::int64_t>(i);
          if (numbered) pose.seq = static_cast<std::int64_t>(i);
          if (i == damaged)
            pose.pose.time_us =
                static_cast<std::int64_t>(static_cast<std::uint64_t>(pose.pose.time_us) ^ (1ULL << bit));
          else
            expected.push_back(pose.pose.time_us);
          take(stream.push(pose));
        }
        take(stream.flush());
        std::size_t found = 0;
        for (const std::int64_t time : expected) found += std::count(times.begin(), times.end(), time) > 0;
        EXPECT_GE(found + 1, expected.size());
      }
}

}  // namespace
}  // namespace egocal::test_stream
