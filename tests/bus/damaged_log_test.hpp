// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "egocal/bus/log_file.hpp"
#include "support/damaged_log.hpp"
#include "support/in_memory_file.hpp"

namespace egocal::bus {

/// A small log, and what a reader makes of its damaged copies.
class LogFile : public ::testing::Test {
 protected:
  LogFile()
      : folder(std::filesystem::temp_directory_path() / ("egocal_log_" + std::to_string(getpid()))),
        file((std::filesystem::create_directories(folder), folder / "damaged.log")),
        log(test::small_log(folder / "good.log", 30)) {}
  ~LogFile() override { std::filesystem::remove_all(folder); }

  struct Read {
    struct Event {
      std::size_t at;  ///< in the file
      LogEvent event;
    };
    std::vector<Event> events;
    LogDamage damage;
  };
  Read read(const std::string& bytes) const {
    memory.set(bytes.data(), bytes.size());
    LogReader reader(memory.name());
    Read result;
    while (auto event = reader.next()) {
      const std::size_t size = test::log_header_size + event->channel.size() + event->data.size();
      result.events.push_back({reader.position() - size, std::move(*event)});
    }
    result.damage = reader.damage();
    return result;
  }
  /// Everything that is whole was read, from where it stands now, and every byte is accounted for.
  void expect_whole(const test::DamagedLog& damaged, const Read& read) const {
    std::size_t next = 0, bytes = 0;
    for (const Read::Event& event : read.events) {
      const std::size_t size = test::log_header_size + event.event.channel.size() + event.event.data.size();
      bytes += size;
      while (next < damaged.whole.size() && damaged.whole[next].at < event.at) {
        ADD_FAILURE() << "event " << damaged.whole[next].event << " was not read";
        ++next;
      }
      if (next == damaged.whole.size() || damaged.whole[next].at != event.at) continue;
      EXPECT_EQ(event.event.number, static_cast<std::int64_t>(damaged.whole[next].event));
      const std::size_t from = log.begin[damaged.whole[next].event];
      EXPECT_EQ(size, log.begin[damaged.whole[next].event + 1] - from);
      const std::size_t data = from + test::log_header_size + event.event.channel.size();
      EXPECT_EQ(
          log.bytes.compare(data, event.event.data.size(),
                            reinterpret_cast<const char*>(event.event.data.data()), event.event.data.size()),
          0);
      ++next;
    }
    EXPECT_EQ(next, damaged.whole.size()) << "the last ones were not read";
    EXPECT_EQ(bytes + read.damage.bytes, damaged.bytes.size());
  }
  std::string with_field(std::size_t event, std::size_t offset, std::uint32_t value) const {
    std::string bytes = log.bytes;
    for (std::size_t k = 0; k < 4; ++k)
      bytes[log.begin[event] + offset + k] = static_cast<char>(value >> (24 - 8 * k));
    return bytes;
  }
  std::size_t size_of(std::size_t event) const { return log.begin[event + 1] - log.begin[event]; }

  std::filesystem::path folder;
  std::string file;
  test::InMemoryFile memory;
  test::SmallLog log;
};

}  // namespace egocal::bus
