// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/log_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <string>

#include "egocal/error.hpp"
#include "egocal/io/packing.hpp"

namespace egocal::bus {

namespace {

// Each event: sync word, number (8 bytes), time (8), length of the channel (4), length of the data (4),
// channel, data; all big endian.
constexpr std::uint32_t sync_word = 0xEDA1DA01;
constexpr std::size_t header_size = 28;          // bytes, format
constexpr std::int32_t longest_channel = 63;     // LCM_MAX_CHANNEL_NAME_LENGTH
constexpr std::int32_t largest_data = 64 << 20;  // a limit [bytes]
constexpr std::size_t window_size = 1 << 16;     // [bytes] read at once
/// A damaged log may hold any number of names.
constexpr std::size_t most_channels = 1000;
/// Events of several sources are not exactly in order [us].
constexpr std::int64_t disorder_us = 1'000'000;

void put(std::vector<unsigned char>& out, std::uint64_t value, std::size_t count) {
  for (std::size_t i = count; i > 0; --i) out.push_back(static_cast<unsigned char>(value >> (8 * (i - 1))));
}

/// A pipe that is opened would wait for its other end.
std::FILE* open_file(const std::string& file) {
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0)
    throw error_at(file, 0, "", std::string("cannot be opened for reading: ") + std::strerror(errno));
  struct stat status {};
  const bool regular = fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
  std::FILE* const stream = regular ? fdopen(fd, "rb") : nullptr;
  if (!stream) {
    close(fd);
    throw error_at(file, 0, "", "cannot be read as a log: it is not a file");
  }
  return stream;
}

std::string first_bytes(std::FILE* stream) {
  std::array<char, 6> bytes{};
  const ssize_t n = pread(fileno(stream), bytes.data(), bytes.size(), 0);
  return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0))};
}

/// Damaged numbers may be the largest there are.
bool follows(std::int64_t number, std::int64_t before) {
  return static_cast<std::uint64_t>(number) == static_cast<std::uint64_t>(before) + 1;
}

}  // namespace

void EventNumbers::begin_at(std::int64_t number) {
  *this = {};
  if (number <= 0 || number == INT64_MAX) return;
  has_zero_ = true;
  last_ = number - 1;
  top_ = count_ = number;
}

bool EventNumbers::take(std::int64_t number, std::uint64_t damaged_bytes) {
  if (restart_) {
    // The number after the zero shows that the zero was damaged: the count continues as if it had not come.
    const Restart& restart = *restart_;
    if (damaged_bytes == 0 && !follows(number, last_) &&
        static_cast<std::uint64_t>(number) == static_cast<std::uint64_t>(restart.last) + 2) {
      last_ = restart.last + 1;
      top_ = restart.top;
      count_ = restart.count + 1;
      before_ = restart.before;
    }
    restart_.reset();
  }
  bool in_order = follows(number, last_);
  if (number == 0 && has_zero_) {  // another log begins, appended to the one before
    EventNumbers another;
    another.before_ = missing();
    another.restart_ = Restart{last_, top_, count_, before_};
    *this = another;
    in_order = true;
  }
  // If numbers jump and later return to where they would be without the jump, the numbers in between were
  // damaged, and nothing was cut out or inserted there.
  bool back = false;
  if (!in_order && damaged_bytes == 0) {
    back = run_ &&
           static_cast<std::uint64_t>(number) == static_cast<std::uint64_t>(run_->before) + run_->length + 1;
    if (back) top_ = run_->top_before;
    run_ = back ? std::nullopt : std::optional<Run>(Run{last_, top_, 1});
  } else if (run_) {
    ++run_->length;
  }
  // Two numbers in a row confirm each other. After damaged bytes a number is plausible if these can have held
  // the events in between. A single number that fits nothing is damaged itself.
  const std::uint64_t most_between = damaged_bytes / (header_size + 1) + 1;
  const bool close =
      damaged_bytes > 0 && number > last_ &&
      static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(last_) - 1 <= most_between;
  if (number >= 0 && number < INT64_MAX && (in_order || close || back)) top_ = std::max(top_, number + 1);
  has_zero_ = has_zero_ || number == 0;
  last_ = number;
  ++count_;
  return !in_order && damaged_bytes == 0;
}

void EventNumbers::cut_off() {
  // at least one event has begun there, unless that number is known to be missing
  if (follows(top_, last_)) ++top_;
}

std::uint64_t EventNumbers::missing() const {
  return before_ + static_cast<std::uint64_t>(std::max<std::int64_t>(0, top_ - count_));
}

struct LogReader::Place {
  std::uint64_t offset;
  std::int64_t number, time_us;
  std::int32_t channel_size, data_size;

  std::uint64_t data() const { return offset + header_size + static_cast<std::uint64_t>(channel_size); }
  std::uint64_t end() const { return data() + static_cast<std::uint64_t>(data_size); }
};

LogReader::LogReader(const std::string& file) : file_(file), stream_(open_file(file), std::fclose) {
  struct stat status {};
  if (fstat(fileno(stream_.get()), &status) != 0) throw error_at(file, 0, "", "cannot be read as a log");
  size_ = static_cast<std::uint64_t>(status.st_size);
  rewind();
  if (!next()) {
    const std::optional<Packing> packing = packing_of(first_bytes(stream_.get()));
    throw error_at(
        file, 0, "",
        packing ? packed_log_refused(*packing, file) : "is not an LCM log: there is no event in it");
  }
  rewind();
}

void LogReader::rewind() {
  position_ = 0;
  usual_size_.clear();
  numbers_ = {};
  damage_ = {};
}

std::optional<LogReader::Place> LogReader::event_from(std::uint64_t from, std::uint64_t to) const {
  while (const std::optional<Place> place = find_header(from, to)) {
    if (believable(*place)) return place;
    from = place->offset + 1;
  }
  return std::nullopt;
}

/// The median of the times of an event and the two after it, as one of them may be damaged.
std::int64_t LogReader::typical_time(const Place& place) const {
  std::array<std::int64_t, 3> times{place.time_us, place.time_us, place.time_us};
  std::optional<Place> next = place;
  for (std::size_t i = 1; i < times.size() && next; ++i)
    if ((next = header_at(next->end()))) times[i] = next->time_us;
  std::sort(times.begin(), times.end());
  return times[1];
}

void LogReader::seek(std::int64_t time_us) {
  rewind();
  const std::int64_t target = std::max(time_us, INT64_MIN + disorder_us) - disorder_us;
  std::uint64_t before = 0, behind = size_;
  std::optional<Place> found;
  while (behind - before > window_size) {
    const std::uint64_t middle = before + (behind - before) / 2;
    const std::optional<Place> place = event_from(middle, behind);
    if (place && typical_time(*place) < target) {
      before = place->offset;
      found = place;
    } else {
      behind = middle;
    }
  }
  if (!found) return;
  position_ = found->offset;
  numbers_.begin_at(found->number);
}

/// All of these bytes of the file.
bool LogReader::read_at(std::uint64_t offset, void* to, std::size_t size) const {
  const auto read = [this](std::uint64_t from, void* buffer, std::size_t most) {
    std::size_t got = 0;
    while (got < most) {
      const ssize_t n = pread(fileno(stream_.get()), static_cast<char*>(buffer) + got, most - got,
                              static_cast<off_t>(from + got));
      if (n < 0 && errno == EINTR) continue;
      // not the end of the file: a repaired copy of it would lack the rest
      if (n < 0) throw error_at(file_, 0, "", std::string("reading failed: ") + std::strerror(errno));
      if (n == 0) break;
      got += static_cast<std::size_t>(n);
    }
    return got;
  };
  if (offset > size_ || size > size_ - offset) return false;
  if (size == 0) return true;
  if (size > window_size) return read(offset, to, size) == size;
  if (offset < window_at_ || offset + size > window_at_ + window_.size()) {
    window_.resize(std::min<std::uint64_t>(window_size, size_ - offset));
    window_at_ = offset;
    window_.resize(read(offset, window_.data(), window_.size()));
    if (size > window_.size()) return false;
  }
  std::memcpy(to, &window_[offset - window_at_], size);
  return true;
}

std::optional<LogReader::Place> LogReader::header_at(std::uint64_t offset) const {
  std::array<unsigned char, header_size> bytes;
  const Bytes header = std::as_bytes(std::span(bytes));
  if (!read_at(offset, bytes.data(), header_size) || big_endian<std::uint32_t>(header) != sync_word)
    return std::nullopt;
  const Place place{offset, static_cast<std::int64_t>(big_endian<std::uint64_t>(header, 4)),
                    static_cast<std::int64_t>(big_endian<std::uint64_t>(header, 12)),
                    static_cast<std::int32_t>(big_endian<std::uint32_t>(header, 20)),
                    static_cast<std::int32_t>(big_endian<std::uint32_t>(header, 24))};
  if (place.channel_size < 1 || place.channel_size > longest_channel || place.data_size < 0 ||
      place.data_size > largest_data)
    return std::nullopt;
  return place;
}

/// The first header that begins in this part of the file.
std::optional<LogReader::Place> LogReader::find_header(std::uint64_t from, std::uint64_t to) const {
  std::array<unsigned char, 4096> chunk;
  while (from < to) {
    if (std::optional<Place> place = header_at(from)) return place;
    ++from;
    // on to the next byte that a sync word may begin with
    while (from < to) {
      const std::size_t size = std::min<std::uint64_t>(chunk.size(), to - from);
      if (!read_at(from, chunk.data(), size)) return std::nullopt;
      const void* found = std::memchr(chunk.data(), sync_word >> 24, size);
      if (found) {
        from += static_cast<std::uint64_t>(static_cast<const unsigned char*>(found) - chunk.data());
        break;
      }
      from += size;
    }
  }
  return std::nullopt;
}

std::string LogReader::channel_of(const Place& place) const {
  std::string channel(static_cast<std::size_t>(place.channel_size), '\0');
  if (!read_at(place.offset + header_size, channel.data(), channel.size())) channel.clear();
  return channel;
}

/// Whether the header found inside an event continues this log, or belongs to a log that another program has
/// sent as a message. The next number alone proves nothing, as every log has a 1. It is confirmed by a higher
/// number after it, however far (the events in between may be damaged), or by an end at the end of the outer
/// event.
bool LogReader::goes_on(const Place& inner, const Place& outer) const {
  if (!follows(inner.number, outer.number)) return false;
  if (inner.end() == outer.end()) return true;
  const std::optional<Place> next = find_header(inner.offset + header_size, outer.end());
  return next && next->number > inner.number;
}

/// Whether the lengths of an event agree with its surroundings: they decide where the next event is looked
/// for.
bool LogReader::believable(const Place& place) const {
  if (place.end() > size_) return false;
  const std::string channel = channel_of(place);
  if (std::any_of(channel.begin(), channel.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
    return false;
  const std::optional<Place> next = header_at(place.end());
  if (next && follows(next->number, place.number)) return true;
  // Too long: it would swallow other events. If another event begins at its end after all, or the file ends
  // there, only a continuation of the log inside reveals it.
  const bool ends_well = next || place.end() == size_;
  const std::optional<Place> inner = find_header(place.offset + header_size, place.end());
  if (inner && (!ends_well || goes_on(*inner, place))) return false;
  if (ends_well) return true;
  // Too short: bytes are left before an event with the very next number, so they belong to this event. If its
  // channel had an event of this size before, they are events that came in between.
  const std::optional<Place> other = find_header(place.end(), size_);
  if (!other || !follows(other->number, place.number)) return true;
  const auto usual = usual_size_.find(channel);
  return usual != usual_size_.end() && usual->second == place.data_size;
}

std::optional<LogEvent> LogReader::next() {
  const std::uint64_t begin = position_;
  std::uint64_t from = begin;
  while (const std::optional<Place> place = find_header(from, size_)) {
    from = place->offset + 1;
    if (!believable(*place)) continue;
    LogEvent event{place->number, place->time_us, channel_of(*place), {}};
    event.data.resize(static_cast<std::size_t>(place->data_size));
    if (!read_at(place->data(), event.data.data(), event.data.size())) break;  // the file has shrunk
    const std::uint64_t skipped = place->offset - begin;
    if (skipped > 0) ++damage_.regions;
    damage_.bytes += skipped;
    if (numbers_.take(place->number, skipped)) ++damage_.jumps;
    damage_.lost_events = numbers_.missing();
    if (usual_size_.size() < most_channels || usual_size_.contains(event.channel))
      usual_size_[event.channel] = place->data_size;
    position_ = place->end();
    return event;
  }
  if (begin < size_) {
    ++damage_.regions;
    damage_.bytes += size_ - begin;
    damage_.truncated = true;
    numbers_.cut_off();
    damage_.lost_events = numbers_.missing();
    position_ = size_;
  }
  return std::nullopt;
}

LogWriter::LogWriter(const std::string& file) : file_(file), out_(file) {}

void LogWriter::write(std::int64_t time_us, const std::string& channel, Bytes data) {
  if (channel.empty() || channel.size() > static_cast<std::size_t>(longest_channel) ||
      data.size() > static_cast<std::size_t>(largest_data))
    throw error_at(file_, 0, "", "the event on channel '" + channel + "' is larger than a log can hold");
  std::vector<unsigned char> header;
  header.reserve(header_size + channel.size());
  put(header, sync_word, 4);
  put(header, static_cast<std::uint64_t>(number_++), 8);
  put(header, static_cast<std::uint64_t>(time_us), 8);
  put(header, channel.size(), 4);
  put(header, data.size(), 4);
  header.insert(header.end(), channel.begin(), channel.end());
  out_.write(std::as_bytes(std::span(header)));
  out_.write(data);
}

void LogWriter::close() {
  out_.commit();
}

}  // namespace egocal::bus
