// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Files that lie about their sizes take neither memory nor time.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "damaged_log_test.hpp"
#include "egocal/bus/log_file.hpp"
#include "support/damaged_log.hpp"
#include "support/largest_allocation.hpp"

namespace egocal::bus::test_log_file_limits {
namespace {

/// Nothing in it but holes: a file of any size that takes no room.
void extend(const std::string& file, std::uint64_t size) {
  std::filesystem::resize_file(file, size);
}

TEST_F(LogFile, NoEventTakesMoreThan64MiB) {
  constexpr std::uint32_t limit = 64 << 20;
  for (const std::uint32_t size : {limit, limit + 1, 150u << 20}) {
    test::write_bytes(file, log.bytes + with_field(5, 24, size).substr(log.begin[5], size_of(5)));
    extend(file, 200 << 20);
    test::largest_allocation = 0;
    const auto begin = std::chrono::steady_clock::now();
    LogReader reader(file);
    std::size_t events = 0;
    while (reader.next()) ++events;
    EXPECT_EQ(events, log.events() + (size <= limit ? 1 : 0));
    EXPECT_LE(test::largest_allocation, std::size_t{limit} + 4096);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
  }
}

TEST_F(LogFile, AHostileFileTakesNoLongerThanItsSize) {
  // headers in a row that all claim the 64 MiB after them
  const std::string header = with_field(0, 24, 64 << 20).substr(0, test::log_header_size + 13);
  std::string bytes = log.bytes;
  for (int i = 0; i < 50'000; ++i) bytes += header;
  test::write_bytes(file, bytes);
  extend(file, 200 << 20);
  const auto begin = std::chrono::steady_clock::now();
  LogReader reader(file);
  while (reader.next()) {
  }
  EXPECT_EQ(reader.position(), reader.size());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

}  // namespace
}  // namespace egocal::bus::test_log_file_limits
