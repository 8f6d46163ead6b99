// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bag/rosbag1_reader.hpp"

#include <algorithm>

#include "egocal/error.hpp"
#include "io/bytes/little_endian.hpp"

namespace egocal::detail {

namespace {

constexpr std::size_t largest_header = 64 << 10;  // [bytes]; the fields of a record take less than 1 KiB

enum Op : std::uint8_t { message_op = 2, chunk_op = 5, connection_op = 7 };

}  // namespace

/// A record: its header's fields and its data.
struct Rosbag1Reader::Record {
  std::uint8_t op = 0;
  std::uint32_t connection = 0, unpacked_size = 0;
  std::int64_t time_ns = 0;
  std::string_view compression, topic, type;
  ByteSpan data;
};

namespace {

/// "name=value" fields, each with its 32-bit length before it. False where lengths and names make no sense.
template <class Record>
bool parse_fields(ByteSpan header, Record& record) {
  LittleEndian from(header);
  bool has_op = false;
  while (from.ok() && from.left() > 0) {
    const std::string_view field = from.text();
    const std::size_t equals = field.find('=');
    if (!from.ok() || equals == std::string_view::npos || equals == 0) return false;
    const std::string_view name = field.substr(0, equals), value = field.substr(equals + 1);
    LittleEndian number(ByteSpan(reinterpret_cast<const unsigned char*>(value.data()), value.size()));
    if (name == "op") {
      record.op = number.u8();
      has_op = number.complete();
    } else if (name == "conn") {
      record.connection = number.u32();
    } else if (name == "time") {
      const std::int64_t seconds = number.u32();
      record.time_ns = seconds * 1'000'000'000 + number.u32();
    } else if (name == "size") {
      record.unpacked_size = number.u32();
    } else if (name == "compression") {
      record.compression = value;
    } else if (name == "topic") {
      record.topic = value;
    } else if (name == "type") {
      record.type = value;
    }
  }
  return from.ok() && has_op;
}

bool known_compression(std::string_view name) {
  return name == "none" || name == "bz2" || name == "lz4";
}

/// Header, and the length of the data; 0: these bytes begin no record.
template <class Record>
std::size_t parse_head(ByteSpan bytes, Record& record, std::uint32_t& data_size) {
  LittleEndian from(bytes);
  const std::uint32_t header_size = from.u32();
  if (header_size < 8 || header_size > largest_header) return 0;
  const ByteSpan header = from.take(header_size);
  data_size = from.u32();
  if (!from.ok() || !parse_fields(header, record)) return 0;
  if (record.op == chunk_op && !known_compression(record.compression)) return 0;
  return bytes.size() - from.left();
}

}  // namespace

Rosbag1Reader::Rosbag1Reader(std::unique_ptr<ByteSource> source)
    : source_(std::move(source)), bz2_(make_unpacker("bz2")), lz4_(make_unpacker("lz4")) {
  const ByteSpan first = source_->peek(rosbag1_magic.size());
  if (!std::equal(rosbag1_magic.begin(), rosbag1_magic.end(), first.begin(), first.end()))
    throw error_at(source_->file(), 0, "", "is no ROS 1 bag: expected '#ROSBAG V2.0' at the beginning");
  source_->skip(rosbag1_magic.size());
}

void Rosbag1Reader::rewind() {
  source_->rewind();
  source_->skip(rosbag1_magic.size());
  in_chunk_ = false;
  pending_ = 0;
  connections_.clear();
  losses_ = {};
}

bool Rosbag1Reader::next(BagMessage& message) {
  Record record;
  while (true) {
    record = {};
    if (in_chunk_) {
      if (!next_in_chunk(record)) continue;
    } else {
      source_->skip(std::exchange(pending_, 0));
      if (!next_in_file(record)) {
        source_->count_unpacking(losses_);
        if (in_chunk_) continue;  // the part of the last chunk that has arrived
        return false;
      }
    }
    if (record.op == chunk_op && !in_chunk_) open_chunk(record, false);
    if (record.op == connection_op) take_connection(record);
    if (record.op != message_op) continue;
    const auto topic = connections_.find(record.connection);
    if (topic == connections_.end()) {
      ++losses_.regions;
      continue;
    }
    message = {topic->second, record.time_ns, record.data};
    return true;
  }
}

bool Rosbag1Reader::next_in_file(Record& record) {
  while (true) {
    const ByteSpan length = source_->peek(4);
    if (length.empty()) return false;
    const std::uint32_t header_size = LittleEndian(length).u32();
    std::uint32_t data_size = 0;
    record = {};
    const std::size_t head =
        header_size > largest_header ? 0 : parse_head(source_->peek(8 + header_size), record, data_size);
    if (head > 0 && data_size <= largest_record) {
      const ByteSpan whole = source_->peek(head + data_size);
      record = {};
      parse_head(whole, record, data_size);  // its texts are in the new window
      record.data = whole.subspan(head);
      if (whole.size() == head + data_size) {
        pending_ = whole.size();
        return true;
      }
      losses_.truncated = true;
      if (record.op == chunk_op) open_chunk(record, true);
      source_->skip(whole.size());
      return false;
    }
    if (!find_next_record()) return false;
  }
}

bool Rosbag1Reader::find_next_record() {
  ++losses_.regions;
  const std::uint64_t begin = source_->offset();
  source_->skip(1);
  constexpr std::size_t look = 4096;  // for the header of a record [bytes]
  while (true) {
    const ByteSpan window = source_->peek(128 << 10);
    const bool last = window.size() < (128 << 10);
    const std::size_t end = last ? window.size() : window.size() - look;
    for (std::size_t at = 0; at < end; ++at) {
      if (at + 2 < window.size() && window[at + 2] != 0) continue;  // headers are shorter than 64 KiB
      Record record;
      std::uint32_t data_size = 0;
      const ByteSpan there = window.subspan(at);
      if (parse_head(there.first(std::min(look, there.size())), record, data_size) == 0) continue;
      if (data_size > largest_record) continue;
      source_->skip(at);
      losses_.bytes += source_->offset() - begin;
      return true;
    }
    source_->skip(end);
    if (last) break;
  }
  losses_.bytes += source_->offset() - begin;
  losses_.truncated = true;
  return false;
}

void Rosbag1Reader::open_chunk(const Record& record, bool cut_off) {
  in_chunk_ = false;
  bool whole = true;
  const std::size_t expected = record.unpacked_size;
  if (record.compression == "none" || expected > largest_record) {
    chunk_.assign(record.data.begin(), record.data.end());
  } else {
    constexpr std::size_t slack = 64;  // bytes, so that too long a chunk is noticed
    whole = unpack_all(record.compression == "bz2" ? *bz2_ : *lz4_, record.data, expected + slack, chunk_);
  }
  // what could be unpacked of a damaged chunk is sound: lz4 and bz2 check their blocks
  if (!cut_off && (!whole || chunk_.size() != expected)) {
    ++losses_.regions;
    losses_.bytes += expected > chunk_.size() ? expected - chunk_.size() : 0;
  }
  in_chunk_ = true;
  chunk_cut_off_ = cut_off || !whole;
  chunk_at_ = 0;
}

bool Rosbag1Reader::next_in_chunk(Record& record) {
  const ByteSpan left = ByteSpan(chunk_).subspan(chunk_at_);
  std::uint32_t data_size = 0;
  const std::size_t head = parse_head(left, record, data_size);
  if (head > 0 && data_size <= left.size() - head) {
    record.data = left.subspan(head, data_size);
    chunk_at_ += head + data_size;
    return true;
  }
  if (!left.empty() && !chunk_cut_off_) {
    ++losses_.regions;
    losses_.bytes += left.size();
  }
  in_chunk_ = false;
  return false;
}

void Rosbag1Reader::take_connection(const Record& record) {
  Record described;  // the data is a header of its own, without an op
  described.type = {};
  LittleEndian from(record.data);
  while (from.ok() && from.left() > 0) {
    const std::string_view field = from.text();
    if (field.rfind("type=", 0) == 0) described.type = field.substr(5);
  }
  const std::pair<std::string, std::string> key{record.topic, described.type};
  const auto [entry, fresh] = known_.try_emplace(key, topics_.size());
  if (fresh) topics_.push_back({key.first, ros1_type_name(key.second), "ros1"});
  connections_[record.connection] = entry->second;
}

}  // namespace egocal::detail
