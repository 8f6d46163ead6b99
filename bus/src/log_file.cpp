// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/log_file.hpp"

#include <array>
#include <cstring>

#include "egocal/error.hpp"

namespace egocal::bus {

namespace {

// Every event: sync word, number (8 bytes), time (8), length of the channel (4), length of the data (4),
// both, all big endian.
constexpr std::uint32_t sync_word = 0xEDA1DA01;
constexpr std::size_t header_size = 28;
constexpr std::int32_t longest_channel = 256;
constexpr std::int32_t largest_data = 64 << 20;

using Header = std::array<unsigned char, header_size>;

std::uint64_t big_endian(const unsigned char* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

void put(std::vector<unsigned char>& out, std::uint64_t value, std::size_t count) {
  for (std::size_t i = count; i > 0; --i) out.push_back(static_cast<unsigned char>(value >> (8 * (i - 1))));
}

struct Fields {
  std::int64_t number, time_us;
  std::int32_t channel_size, data_size;
  bool plausible;
};

Fields fields_of(const Header& header) {
  Fields fields{static_cast<std::int64_t>(big_endian(&header[4], 8)),
                static_cast<std::int64_t>(big_endian(&header[12], 8)),
                static_cast<std::int32_t>(big_endian(&header[20], 4)),
                static_cast<std::int32_t>(big_endian(&header[24], 4)), false};
  fields.plausible = big_endian(header.data(), 4) == sync_word && fields.channel_size > 0 &&
                     fields.channel_size <= longest_channel && fields.data_size >= 0 &&
                     fields.data_size <= largest_data;
  return fields;
}

/// The header of an event inside of another one's data.
bool holds_event(const std::vector<std::byte>& data) {
  for (std::size_t i = 0; i + header_size <= data.size(); ++i) {
    Header header;
    std::memcpy(header.data(), &data[i], header_size);
    if (fields_of(header).plausible) return true;
  }
  return false;
}

}  // namespace

LogReader::LogReader(const std::string& file)
    : file_(file), stream_(std::fopen(file.c_str(), "rb"), std::fclose) {
  if (!stream_) throw error_at(file, 0, "", "cannot be opened for reading");
  if (fseeko(stream_.get(), 0, SEEK_END) != 0) throw error_at(file, 0, "", "cannot be read as a log");
  size_ = static_cast<std::uint64_t>(ftello(stream_.get()));
  rewind();
  if (!next()) throw error_at(file, 0, "", "is not an LCM log: there is no event in it");
  rewind();
}

void LogReader::rewind() {
  position_ = 0;
  last_number_.reset();
  damage_ = {};
  std::fseek(stream_.get(), 0, SEEK_SET);
}

/// Is there the header of an event, and where does the event end?
bool LogReader::header_at(std::uint64_t offset, std::uint64_t& event_size) const {
  Header header;
  if (offset + header_size > size_ || fseeko(stream_.get(), static_cast<off_t>(offset), SEEK_SET) != 0 ||
      std::fread(header.data(), 1, header_size, stream_.get()) != header_size)
    return false;
  const Fields fields = fields_of(header);
  event_size = header_size + static_cast<std::uint64_t>(fields.channel_size) +
               static_cast<std::uint64_t>(fields.data_size);
  return fields.plausible;
}

LogReader::Parse LogReader::parse(LogEvent& event) {
  if (position_ >= size_) return Parse::end;
  if (fseeko(stream_.get(), static_cast<off_t>(position_), SEEK_SET) != 0) return Parse::end;
  Header header;
  if (size_ - position_ < header_size ||
      std::fread(header.data(), 1, header_size, stream_.get()) != header_size)
    return Parse::damaged;
  const Fields fields = fields_of(header);
  if (!fields.plausible) return Parse::damaged;
  const std::uint64_t end = position_ + header_size + static_cast<std::uint64_t>(fields.channel_size) +
                            static_cast<std::uint64_t>(fields.data_size);
  if (end > size_) return Parse::damaged;
  event.number = fields.number;
  event.time_us = fields.time_us;
  event.channel.resize(static_cast<std::size_t>(fields.channel_size));
  event.data.resize(static_cast<std::size_t>(fields.data_size));
  if (std::fread(event.channel.data(), 1, event.channel.size(), stream_.get()) != event.channel.size() ||
      std::fread(event.data.data(), 1, event.data.size(), stream_.get()) != event.data.size())
    return Parse::damaged;
  // A length that was damaged points into the middle of something: after an event comes another one, or the
  // end.
  std::uint64_t next_size = 0;
  if (end < size_ && !header_at(end, next_size)) {
    if (holds_event(event.data)) return Parse::damaged;
  }
  position_ = end;
  return Parse::event;
}

/// From the byte after position_ to the next plausible header.
bool LogReader::skip_to_sync() {
  constexpr std::size_t chunk = 1 << 16;
  std::vector<unsigned char> buffer(chunk);
  std::uint64_t from = position_ + 1;
  while (from + header_size <= size_) {
    if (fseeko(stream_.get(), static_cast<off_t>(from), SEEK_SET) != 0) return false;
    const std::size_t got = std::fread(buffer.data(), 1, chunk, stream_.get());
    if (got < 4) return false;
    for (std::size_t i = 0; i + 4 <= got; ++i) {
      if (big_endian(&buffer[i], 4) != sync_word) continue;
      std::uint64_t event_size = 0;
      if (header_at(from + i, event_size) && from + i + event_size <= size_) {
        position_ = from + i;
        return true;
      }
    }
    from += got - 3;
  }
  return false;
}

std::optional<LogEvent> LogReader::next() {
  LogEvent event;
  const std::uint64_t begin = position_;
  while (true) {
    switch (parse(event)) {
      case Parse::end:
        return std::nullopt;
      case Parse::event: {
        const std::uint64_t event_bytes = header_size + event.channel.size() + event.data.size();
        const std::uint64_t skipped = position_ - event_bytes - begin;
        if (skipped > 0) {
          ++damage_.regions;
          damage_.bytes += skipped;
        }
        // numbers that jump far are damaged themselves (or another recording begins); they say nothing of
        // losses
        constexpr std::int64_t most_lost = 10'000'000;
        if (skipped > 0 && last_number_ && event.number > *last_number_ + 1 &&
            event.number - *last_number_ < most_lost)
          damage_.lost_events += static_cast<std::uint64_t>(event.number - *last_number_ - 1);
        last_number_ = event.number;
        return event;
      }
      case Parse::damaged:
        if (!skip_to_sync()) {
          damage_.truncated = true;
          ++damage_.regions;
          damage_.bytes += size_ - begin;
          position_ = size_;
          return std::nullopt;
        }
    }
  }
}

LogWriter::LogWriter(const std::string& file)
    : file_(file), stream_(std::fopen((file + ".part").c_str(), "wb"), std::fclose) {
  if (!stream_) throw error_at(file, 0, "", "cannot be written");
}

LogWriter::~LogWriter() {
  if (!stream_) return;
  stream_.reset();
  std::remove((file_ + ".part").c_str());
}

void LogWriter::write(std::int64_t time_us, const std::string& channel, Bytes data) {
  std::vector<unsigned char> header;
  header.reserve(header_size + channel.size());
  put(header, sync_word, 4);
  put(header, static_cast<std::uint64_t>(number_++), 8);
  put(header, static_cast<std::uint64_t>(time_us), 8);
  put(header, channel.size(), 4);
  put(header, data.size(), 4);
  header.insert(header.end(), channel.begin(), channel.end());
  if (std::fwrite(header.data(), 1, header.size(), stream_.get()) != header.size() ||
      std::fwrite(data.data(), 1, data.size(), stream_.get()) != data.size())
    throw error_at(file_, 0, "", "cannot be written");
}

void LogWriter::close() {
  const bool written = std::fflush(stream_.get()) == 0;
  stream_.reset();
  const std::string part = file_ + ".part";
  if (!written || std::rename(part.c_str(), file_.c_str()) != 0) {
    std::remove(part.c_str());
    throw error_at(file_, 0, "", "cannot be written");
  }
}

}  // namespace egocal::bus
