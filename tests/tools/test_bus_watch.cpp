// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The process that listens to the bus for `egocal up`, where it fails.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "egocal/error.hpp"
#include "supervision/bus_watch.hpp"

namespace egocal::tools::test_bus_watch {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

bus::Rig rig() {
  return bus::parse_rig(
      "[[sensor]]\nname = \"left\"\nchannel = \"L\"\n[[sensor]]\nname = \"right\"\nchannel = \"R\"\n"
      "[[pair]]\na = \"left\"\nb = \"right\"\n",
      "rig.toml");
}

/// Until the process that writes it has ended.
std::string read_all(int fd) {
  std::string text;
  char part[512];
  for (pollfd ready{fd, POLLIN, 0}; poll(&ready, 1, 30'000) > 0;) {
    const ssize_t n = read(fd, part, sizeof part);
    if (n <= 0) break;
    text.append(part, static_cast<std::size_t>(n));
  }
  return text;
}

// It was "was killed"
TEST(BusWatch, SaysWhyTheListeningProcessFailed) {
  const bus::Rig two = rig();
  BusWatch watch(two, "memq://", "/nonexistent/drive.log");
  EXPECT_THAT(read_all(watch.lines()),
              StartsWith("the process that listens to the bus failed: /nonexistent/drive.log: cannot be"));
  std::string why;
  try {
    watch.outcome();
  } catch (const Error& error) {
    why = error.what();
  }
  EXPECT_THAT(why, HasSubstr("failed, what was calibrated is not known: /nonexistent/drive.log: cannot be"));
}

pid_t only_child() {
  std::ifstream children("/proc/self/task/" + std::to_string(getpid()) + "/children");
  pid_t child = -1;
  children >> child;
  return child;
}

// As by the kernel where memory is short: what is reported of the other processes would end with it.
TEST(BusWatch, ListensAgainWhereItsProcessWasKilled) {
  const bus::Rig two = rig();
  BusWatch watch(two, "memq://", "", {{}, {}, std::chrono::milliseconds(0)});
  const pid_t first = only_child();
  ASSERT_GT(first, 0);
  kill(first, SIGKILL);
  EXPECT_EQ(read_all(watch.lines()), "");
  const std::optional<int> lines = watch.listen_again();
  ASSERT_TRUE(lines);
  EXPECT_EQ(*lines, watch.lines());
  EXPECT_NE(only_child(), first);
  pollfd ended{*lines, POLLIN, 0};
  EXPECT_EQ(poll(&ended, 1, 300), 0);

  BusWatch at_once(two, "memq://", "/nonexistent/drive.log");
  read_all(at_once.lines());
  EXPECT_FALSE(at_once.listen_again());
}

std::size_t open_files() {
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

/// Of memory that this process shares with others.
std::size_t shared_mappings() {
  std::ifstream maps("/proc/self/maps");
  std::size_t count = 0;
  for (std::string line; std::getline(maps, line);) count += line.find("/dev/zero") != std::string::npos;
  return count;
}

TEST(BusWatch, LeavesNothingOpenWhereItCannotBegin) {
  const std::size_t files = open_files(), mappings = shared_mappings();
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit tight{64, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &tight), 0);
  std::vector<Descriptor> filled;
  for (int fd = 0; (fd = open("/dev/null", O_RDONLY)) >= 0;) filled.emplace_back(fd);
  ASSERT_GT(filled.size(), 3u);
  filled.resize(filled.size() - 3);  // room for one pipe of two
  const bus::Rig two = rig();
  EXPECT_THROW(BusWatch(two, "memq://", ""), Error);
  filled.clear();
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(open_files(), files);
  EXPECT_EQ(shared_mappings(), mappings);
}

}  // namespace
}  // namespace egocal::tools::test_bus_watch
