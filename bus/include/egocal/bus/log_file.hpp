// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "egocal/bus/decode.hpp"
#include "egocal/io/whole_file.hpp"

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
  std::uint64_t lost_events = 0;  ///< numbers that never came; what is cut off at the end counts as one event
  std::uint64_t jumps = 0;  ///< numbers out of order where no byte is damaged: blocks cut out or swapped
  bool truncated = false;   ///< the file ends in the middle of an event

  bool any() const { return regions + lost_events + jumps > 0; }
};

/// What the numbers of a log's events say. lcm-logger, and whatever writes through liblcm, counts up from 0:
/// so what is missing can be counted in whatever order the rest comes, and a damaged number differs from a
/// lost event.
class EventNumbers {
 public:
  /// Counts an event that has been read, this many damaged bytes after the one before. True: the number is
  /// not the next one.
  bool take(std::int64_t number, std::uint64_t damaged_bytes);
  /// Begins with the event of this number; what is before it is not missed.
  void begin_at(std::int64_t number);
  /// The file ends with damaged bytes.
  void cut_off();
  std::uint64_t missing() const;

 private:
  bool has_zero_ = false;
  std::int64_t last_ = -1;    ///< number of the last event
  std::int64_t top_ = 0;      ///< one more than the highest number that can be believed
  std::int64_t count_ = 0;    ///< events read
  std::uint64_t before_ = 0;  ///< missing from the logs before, in a file of several
  struct Run {
    std::int64_t before, top_before;
    std::uint64_t length;
  };
  std::optional<Run> run_;  ///< since the numbers jumped last: the number and the top before it, events since
  struct Restart {
    std::int64_t last, top, count;
    std::uint64_t before;
  };
  std::optional<Restart> restart_;  ///< the last event began another log: what was known before it
};

/// Reads the event logs of lcm-logger from a file, not from a pipe. A damaged region costs only its own
/// events: the reader continues at the next plausible event (liblcm's own reader ends there silently). An
/// event with impossible lengths is skipped. Other damage inside an event is visible only to its decoder. The
/// memory is that of one event, at most 64 MiB whatever a damaged length field says, and the time is
/// proportional to the size of the file. A copy reads on by itself, in the same open file: its name may have
/// been given to another one since.
class LogReader {
 public:
  /// Throws Error where the file cannot be opened or is not a log at all (no event in it).
  explicit LogReader(const std::string& file);

  /// The next event; empty at the end. Throws Error where the file cannot be read.
  std::optional<LogEvent> next();
  /// Goes back to the first event.
  void rewind();
  /// Moves by bisection to a place before every event that was recorded at time_us or later. next() continues
  /// there, possibly with events that are a little earlier. Times must ascend, except for the disorder of
  /// several sources (1 s) and single damaged times; otherwise the place is earlier than necessary, at worst
  /// the start of the file. Damage is counted from there on.
  void seek(std::int64_t time_us);

  const LogDamage& damage() const { return damage_; }
  std::uint64_t position() const { return position_; }  ///< bytes read
  std::uint64_t size() const { return size_; }          ///< of the file [bytes]

 private:
  struct Place;  // the header of an event, and where it stands in the file
  bool read_at(std::uint64_t offset, void* to, std::size_t size) const;
  std::optional<Place> header_at(std::uint64_t offset) const;
  std::optional<Place> find_header(std::uint64_t from, std::uint64_t to) const;
  std::optional<Place> event_from(std::uint64_t from, std::uint64_t to) const;
  std::int64_t typical_time(const Place& place) const;
  bool goes_on(const Place& inner, const Place& outer) const;
  bool believable(const Place& place) const;
  std::string channel_of(const Place& place) const;

  std::string file_;
  std::shared_ptr<std::FILE> stream_;          ///< read at places, so copies share it
  mutable std::vector<unsigned char> window_;  ///< a piece of the file ...
  mutable std::uint64_t window_at_ = 0;        ///< ... that begins here
  std::uint64_t position_ = 0, size_ = 0;
  std::map<std::string, std::int32_t> usual_size_;  ///< of the data of each channel's last event
  EventNumbers numbers_;
  LogDamage damage_;
};

/// Writes a log that lcm-logplayer plays. The file takes its name when close() is called (see WholeFile);
/// without that nothing remains. What is there under that name must be a file, or nothing: no device is ever
/// replaced.
class LogWriter {
 public:
  explicit LogWriter(const std::string& file);  ///< throws Error

  /// Throws Error where the disk is full, the log is closed, or the event is larger than a log can hold (63
  /// characters, 64 MiB).
  void write(std::int64_t time_us, const std::string& channel, Bytes data);
  void close();  ///< throws Error; a second call does nothing

 private:
  std::string file_;
  WholeFile out_;
  std::int64_t number_ = 0;
};

}  // namespace egocal::bus
