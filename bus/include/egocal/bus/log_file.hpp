// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "egocal/bus/decode.hpp"

namespace egocal::bus {

/// One event of an LCM log.
struct LogEvent {
  std::int64_t number = 0;   ///< as in the file
  std::int64_t time_us = 0;  ///< when it was recorded [us]
  std::string channel;
  std::vector<std::byte> data;
};

/// What a log has lost.
struct LogDamage {
  std::uint64_t regions = 0;      ///< damaged places that were skipped
  std::uint64_t bytes = 0;        ///< in them
  std::uint64_t lost_events = 0;  ///< missing numbers between the events that could be read
  bool truncated = false;         ///< the file ends in the middle of an event
};

/// Reads the event logs of lcm-logger. A damaged region costs what it held: the reader goes on at the next
/// event that makes sense (liblcm's own reader ends there, without a word). Memory is that of one event, and
/// no length field of a damaged event makes it more than 64 MiB.
class LogReader {
 public:
  /// Throws Error where the file cannot be opened or is not a log at all (no event in it).
  explicit LogReader(const std::string& file);

  /// The next event; empty at the end.
  std::optional<LogEvent> next();
  /// Back to the first event.
  void rewind();

  const LogDamage& damage() const { return damage_; }
  std::uint64_t position() const { return position_; }  ///< bytes read
  std::uint64_t size() const { return size_; }          ///< of the file [bytes]

 private:
  enum class Parse { event, damaged, end };
  Parse parse(LogEvent& event);
  bool skip_to_sync();
  bool header_at(std::uint64_t offset, std::uint64_t& event_size) const;

  std::string file_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
  std::uint64_t position_ = 0, size_ = 0;
  std::optional<std::int64_t> last_number_;
  LogDamage damage_;
};

/// Writes a log that lcm-logplayer plays. The file takes its name when close() is called; without that
/// nothing remains.
class LogWriter {
 public:
  explicit LogWriter(const std::string& file);  ///< throws Error
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  void write(std::int64_t time_us, const std::string& channel, Bytes data);
  void close();  ///< throws Error

 private:
  std::string file_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
  std::int64_t number_ = 0;
};

}  // namespace egocal::bus
