// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>

#include "offline/common/beside.hpp"

namespace egocal::tools::test_beside_threads {
namespace {

void fail(const char* what) {
  throw std::runtime_error(what);
}

std::string thrown(const std::function<void()>& first, const std::function<void()>& second) {
  try {
    at_the_same_time(first, second);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

/// Each waits for the other one: one after the other would never end.
TEST(AtTheSameTime, BothRun) {
  std::atomic<int> begun = 0;
  const auto meet = [&begun] {
    ++begun;
    while (begun < 2) std::this_thread::yield();
  };
  at_the_same_time(meet, meet);
  EXPECT_EQ(begun, 2);
}

TEST(AtTheSameTime, WhatTheFirstOneThrowsCountsBeforeTheSecond) {
  bool done = false;
  EXPECT_EQ(thrown([] { fail("first"); }, [] { fail("second"); }), "first");
  EXPECT_EQ(thrown([] { fail("first"); }, [&] { done = true; }), "first");
  EXPECT_TRUE(done);
  EXPECT_EQ(thrown([] {}, [] { fail("second"); }), "second");
  EXPECT_EQ(thrown([] {}, [] {}), "");
}

}  // namespace
}  // namespace egocal::tools::test_beside_threads
