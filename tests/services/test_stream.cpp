// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pairing/stream.hpp"

namespace egocal::services {
namespace {

using testing::ElementsAre;

/// Messages at 10 Hz, numbered from 0; time in steps of 0.1 s.
Sample sample(std::int64_t step, std::int64_t seq) {
  Sample s;
  s.pose.time_us = 1'000'000'000 + step * 100'000;
  s.seq = seq;
  return s;
}

std::vector<std::int64_t> feed(Stream& stream, std::initializer_list<Sample> samples) {
  std::vector<std::int64_t> steps;
  for (const Sample& s : samples)
    for (const Sample& out : stream.push(s)) {
      if (out.begins_anew) steps.push_back(-1);
      steps.push_back((out.pose.time_us - 1'000'000'000) / 100'000);
    }
  return steps;
}

TEST(Stream, InOrderPassesAtOnce) {
  Stream stream(0.2);
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(1, 1), sample(2, 2)}), ElementsAre(0, 1, 2));
}

TEST(Stream, SwappedMessagesAreSwappedBack) {
  Stream stream(0.2);
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(2, 2), sample(1, 1), sample(3, 3)}),
              ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(stream.counts().lost, 0);
}

TEST(Stream, ALostOneIsWaitedForByMeasuredTime) {
  Stream stream(0.2);
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(2, 2), sample(3, 3)}), ElementsAre(0));
  EXPECT_TRUE(stream.waiting());
  EXPECT_THAT(feed(stream, {sample(4, 4)}), ElementsAre(2, 3, 4));
  EXPECT_EQ(stream.counts().lost, 1);
  EXPECT_THAT(feed(stream, {sample(1, 1), sample(5, 5)}), ElementsAre(5));
  EXPECT_EQ(stream.counts().out_of_order, 1);
  EXPECT_EQ(stream.counts().lost, 0) << "it came after all";
}

TEST(Stream, FlushGivesUpWaiting) {
  Stream stream(0.2);
  feed(stream, {sample(0, 0), sample(2, 2)});
  EXPECT_EQ(stream.flush().size(), 1u);
  EXPECT_EQ(stream.counts().lost, 1);
}

TEST(Stream, DuplicatesAreCounted) {
  Stream stream(0.2);
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(1, 1), sample(1, 1), sample(0, 0), sample(2, 2)}),
              ElementsAre(0, 1, 2));
  EXPECT_EQ(stream.counts().duplicate, 2);
}

TEST(Stream, OneDamagedTimeOrNumberEndsNothing) {
  Stream stream(0.2);
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(1, 1), sample(-9000, 2), sample(2, 3), sample(5'000'000, 4),
                            sample(3, 5), sample(4, 1'000'000), sample(5, 6), sample(6, 7), sample(7, 8)}),
              ElementsAre(0, 1, 2, 3, 5, 6, 7));
  EXPECT_EQ(stream.counts().jump, 3);
}

TEST(Stream, ALogThatStartsAgainBeginsANewTimelineAndLosesNothing) {
  Stream stream(0.2);
  for (int i = 0; i < 100; ++i) stream.push(sample(i, i));
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(1, 1), sample(2, 2), sample(3, 3)}),
              ElementsAre(-1, 0, 1, 2, 3));
  EXPECT_EQ(stream.counts().jump, 0);
}

TEST(Stream, AGapInTheLogIsNoNewTimeline) {
  Stream stream(0.2);
  feed(stream, {sample(0, -1), sample(1, -1)});
  EXPECT_THAT(feed(stream, {sample(5000, -1), sample(5001, -1), sample(5002, -1)}),
              ElementsAre(5000, 5001, 5002));
}

TEST(Stream, ASourceThatCountsAnewGoesOn) {
  Stream stream(0.2);
  for (int i = 0; i < 2000; ++i) stream.push(sample(i, i));
  EXPECT_THAT(feed(stream, {sample(2000, 0), sample(2001, 1), sample(2002, 2), sample(2003, 3)}),
              ElementsAre(2000, 2001, 2002, 2003));
}

TEST(Stream, MemoryIsBounded) {
  Stream stream(1e9);
  stream.push(sample(0, 0));
  std::size_t out = 0;
  for (int i = 2; i < 5000; ++i) out += stream.push(sample(i, i)).size();
  EXPECT_GT(out, 3000u);
}

TEST(Stream, APatientOneWaitsForWhatWillBeSentAgain) {
  Stream stream(0.2);
  stream.be_patient(true);
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(3, 3), sample(20, 20), sample(40, 40)}), ElementsAre(0));
  EXPECT_THAT(feed(stream, {sample(1, 1), sample(2, 2), sample(3, 3)}), ElementsAre(1, 2, 3));
  EXPECT_EQ(stream.counts().lost, 0);
}

TEST(Stream, APatientOneGivesUpWhatTheSenderDoesNotHave) {
  Stream stream(0.2);
  stream.be_patient(true);
  EXPECT_THAT(feed(stream, {sample(0, 0), sample(2, 2), sample(3, 3), sample(2, 2), sample(3, 3)}),
              ElementsAre(0));
  EXPECT_THAT(feed(stream, {sample(2, 2), sample(3, 3)}), ElementsAre(2, 3));
  EXPECT_EQ(stream.counts().lost, 1);
  EXPECT_FALSE(stream.waiting());
}

TEST(Stream, WithoutNumbersLateOnesPassOnceForTheDriveToJudge) {
  Stream stream(0.2);
  EXPECT_THAT(feed(stream, {sample(0, -1), sample(2, -1), sample(1, -1), sample(3, -1), sample(1, -1)}),
              ElementsAre(0, 2, 1, 3));
  EXPECT_EQ(stream.counts().duplicate, 1);
  EXPECT_EQ(stream.counts().out_of_order, 0);
}

TEST(Stream, WhatWasLostAndComesVeryLateBeginsNoNewTimeline) {
  Stream stream(0.2);
  feed(stream, {sample(0, 0), sample(1, 1)});
  for (std::int64_t i = 6; i < 60; ++i) feed(stream, {sample(i, i)});
  EXPECT_EQ(stream.counts().lost, 4);
  EXPECT_THAT(feed(stream, {sample(2, 2), sample(3, 3), sample(4, 4), sample(5, 5), sample(60, 60)}),
              ElementsAre(60));
  EXPECT_EQ(stream.counts().lost, 0);
  EXPECT_EQ(stream.counts().out_of_order, 4);
}

TEST(Stream, ADamagedNumberFarAheadCostsOneMessage) {
  Stream stream(0.2);
  feed(stream, {sample(0, 0), sample(1, 513)});
  EXPECT_THAT(feed(stream, {sample(2, 2), sample(3, 3), sample(4, 4)}), ElementsAre(2, 3, 4));
  EXPECT_FALSE(stream.waiting());
  EXPECT_THAT(stream.flush(), ::testing::IsEmpty());
  EXPECT_THAT(feed(stream, {sample(5, 5)}), ElementsAre(5));
  EXPECT_EQ(stream.counts().lost, 1);
}

TEST(Stream, AfterAnInterruptionMessagesWithoutNumbersArePutInOrder) {
  Stream stream(0.2);
  feed(stream, {sample(0, -1), sample(1, -1)});
  stream.settle();
  EXPECT_THAT(feed(stream, {sample(5, -1), sample(6, -1), sample(1, -1), sample(2, -1), sample(3, -1),
                            sample(4, -1)}),
              ElementsAre());
  EXPECT_THAT(feed(stream, {sample(5, -1), sample(6, -1), sample(7, -1)}), ElementsAre(2, 3, 4, 5, 6, 7));
}

}  // namespace
}  // namespace egocal::services
