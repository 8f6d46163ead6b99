// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bag/mcap_records.hpp"

#include <zlib.h>

#include <algorithm>
#include <utility>

#include "egocal/error.hpp"
#include "io/bag/message_reader.hpp"
#include "io/bytes/little_endian.hpp"

namespace egocal::detail {

namespace {

constexpr std::size_t head_size = 9;  // opcode and length of a record

struct ChunkHead {
  std::uint64_t unpacked_size = 0;
  std::uint32_t crc = 0;
  std::string_view compression;
  std::uint64_t records_size = 0;
  std::size_t size = 0;  ///< of the head itself [bytes]
};

/// Reads the head of a chunk; false where the head contradicts itself.
bool parse_chunk(ByteSpan content, ChunkHead& head) {
  LittleEndian from(content);
  const std::uint64_t start = from.u64(), end = from.u64();
  head.unpacked_size = from.u64();
  head.crc = from.u32();
  head.compression = from.text();
  head.records_size = from.u64();
  head.size = content.size() - from.left();
  const bool known = head.compression.empty() || head.compression == "lz4" || head.compression == "zstd";
  return from.ok() && start <= end && known;
}

/// Whether the lengths inside a record agree with the record's own length, by as many first bytes as there
/// are. Chance agrees with it once in billions: good enough to take up reading in the middle of a file.
bool self_consistent(McapOpcode opcode, std::uint64_t length, ByteSpan first_bytes) {
  LittleEndian from(first_bytes);
  switch (opcode) {
    case McapOpcode::chunk: {
      ChunkHead head;
      return parse_chunk(first_bytes, head) && head.size + head.records_size == length;
    }
    case McapOpcode::message_index:
      from.u16();
      return length >= 6 && from.u32() == length - 6 && (length - 6) % 16 == 0;
    case McapOpcode::schema:
    case McapOpcode::channel: {
      from.take(opcode == McapOpcode::schema ? 2 : 4);  // ids
      from.text();
      from.text();
      const std::uint64_t last_part = from.u32();
      return from.ok() && first_bytes.size() - from.left() + last_part == length;
    }
    case McapOpcode::message: {
      from.take(6);  // channel, sequence
      const std::uint64_t logged = from.u64(), published = from.u64();
      constexpr std::uint64_t day = 86'400'000'000'000;  // [ns]
      return from.ok() && logged > 0 && published > 0 && logged - published + day < 2 * day;
    }
    case McapOpcode::data_end:
      return length == 4;
    case McapOpcode::footer:
      return length == 20;
    default:
      return false;
  }
}

std::uint32_t crc_of(std::uint32_t before, ByteSpan bytes) {
  return static_cast<std::uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

std::pair<std::uint8_t, std::uint64_t> head_of(ByteSpan bytes) {
  LittleEndian from(bytes);
  const std::uint8_t opcode = from.u8();
  return {opcode, from.u64()};
}

bool begins_with_magic(ByteSpan bytes) {
  return bytes.size() >= mcap_magic.size() &&
         std::equal(mcap_magic.begin(), mcap_magic.end(), bytes.begin(),
                    [](char x, unsigned char y) { return static_cast<unsigned char>(x) == y; });
}

}  // namespace

McapRecords::McapRecords(std::unique_ptr<ByteSource> source)
    : source_(std::move(source)), zstd_(make_unpacker("zstd")), lz4_(make_unpacker("lz4")) {
  if (!begins_with_magic(source_->peek(mcap_magic.size())))
    throw error_at(source_->file(), 0, "", "is no MCAP file: expected its 8 magic bytes at the beginning");
}

void McapRecords::rewind() {
  source_->rewind();
  in_chunk_ = false;
  pending_ = 0;
  data_crc_ = 0;
  crc_usable_ = true;
  losses_ = {};
}

bool McapRecords::next(McapRecord& record) {
  while (true) {
    if (in_chunk_) {
      if (next_in_chunk(record)) return true;
    } else {
      consume(std::exchange(pending_, 0));
      if (!next_in_file(record)) {
        source_->count_unpacking(losses_);
        return in_chunk_ ? next(record) : false;
      }
      if (record.opcode != static_cast<std::uint8_t>(McapOpcode::chunk)) return true;
      open_chunk(record.content, false);
    }
  }
}

void McapRecords::consume(std::size_t size) {
  if (size == 0) return;
  if (crc_usable_) data_crc_ = crc_of(data_crc_, source_->peek(size));
  source_->skip(size);
}

bool McapRecords::next_in_file(McapRecord& record) {
  while (true) {
    const ByteSpan head = source_->peek(head_size);
    if (begins_with_magic(head)) {  // at the beginning, at the end, and between files that were joined
      consume(mcap_magic.size());
      continue;
    }
    if (head.size() < head_size) {
      losses_.truncated = losses_.truncated || !head.empty();
      return false;
    }
    const auto [opcode, length] = head_of(head);
    const std::uint64_t left =
        source_->plain_size() > 0 ? source_->plain_size() - source_->offset() - head_size : UINT64_MAX;
    const bool chunk = opcode == static_cast<std::uint8_t>(McapOpcode::chunk);
    const bool needed = chunk || (opcode >= 1 && opcode <= 5);
    if (length <= largest_record && opcode != 0 && (length <= left || chunk)) {
      const ByteSpan whole = source_->peek(head_size + static_cast<std::size_t>(length));
      const bool there = whole.size() == head_size + length;
      ChunkHead parsed;
      if (chunk && !parse_chunk(whole.subspan(head_size), parsed)) {
        if (!find_next_record()) return false;
        continue;
      }
      if (there) {
        record = {opcode, whole.subspan(head_size)};
        pending_ = whole.size();
        if (opcode == static_cast<std::uint8_t>(McapOpcode::data_end)) {
          const std::uint32_t expected = LittleEndian(record.content).u32();
          losses_.checksum = losses_.checksum || (crc_usable_ && expected != 0 && expected != data_crc_);
          crc_usable_ = false;
        }
        return true;
      }
      if (chunk) {  // what has arrived of the last chunk is read
        losses_.truncated = true;
        open_chunk(whole.subspan(head_size), true);
        source_->skip(whole.size());
        return false;
      }
    } else if (!needed && opcode != 0 && length > largest_record && length <= left) {
      source_->skip(head_size + length);  // an attachment
      crc_usable_ = false;
      continue;
    }
    if (!find_next_record()) return false;
  }
}

bool McapRecords::find_next_record() {
  ++losses_.regions;
  crc_usable_ = false;
  const std::uint64_t begin = source_->offset();
  source_->skip(1);
  constexpr std::size_t look = 256;  // of a record, to be believed
  while (true) {
    const ByteSpan window = source_->peek(128 << 10);
    const std::size_t usable = window.size() < head_size ? 0 : window.size() - head_size + 1;
    const bool last = window.size() < (128 << 10);
    for (std::size_t at = 0; at < (last ? usable : usable - look); ++at) {
      const auto [opcode, length] = head_of(window.subspan(at, head_size));
      if (opcode < 2 || opcode > 15) continue;
      const ByteSpan rest = window.subspan(at + head_size);
      const ByteSpan first = rest.first(std::min<std::size_t>({rest.size(), look, length}));
      if (length > largest_record || !self_consistent(static_cast<McapOpcode>(opcode), length, first))
        continue;
      source_->skip(at);
      losses_.bytes += source_->offset() - begin;
      return true;
    }
    source_->skip(last ? window.size() : usable - look);
    if (last) break;
  }
  losses_.bytes += source_->offset() - begin;
  losses_.truncated = true;
  return false;
}

void McapRecords::open_chunk(ByteSpan content, bool cut_off) {
  ChunkHead head;
  in_chunk_ = false;
  const auto lost = [&] {
    ++losses_.regions;
    losses_.bytes += content.size();
  };
  if (!parse_chunk(content, head)) return lost();
  const ByteSpan packed = content.subspan(head.size, static_cast<std::size_t>(std::min<std::uint64_t>(
                                                         head.records_size, content.size() - head.size)));
  if (head.unpacked_size > largest_record) return lost();
  const auto expected = static_cast<std::size_t>(head.unpacked_size);
  if (head.compression.empty()) {
    chunk_.assign(packed.begin(), packed.end());
  } else {
    constexpr std::size_t slack = 64;  // so that too long a chunk shows
    const bool whole =
        unpack_all(head.compression == "zstd" ? *zstd_ : *lz4_, packed, expected + slack, chunk_);
    if (!whole && !cut_off) return lost();
  }
  if (!cut_off && chunk_.size() != expected) return lost();
  if (!cut_off && head.crc != 0) {
    if (crc_of(0, chunk_) != head.crc) return lost();
    crc_usable_ = false;  // what matters has a checksum of its own
  }
  in_chunk_ = true;
  chunk_cut_off_ = cut_off;
  chunk_at_ = 0;
}

bool McapRecords::next_in_chunk(McapRecord& record) {
  ByteSpan left = ByteSpan(chunk_).subspan(chunk_at_);
  while (left.size() >= head_size) {
    const auto [opcode, length] = head_of(left);
    if (opcode == 0 || length > left.size() - head_size) break;
    record = {opcode, left.subspan(head_size, static_cast<std::size_t>(length))};
    chunk_at_ += head_size + static_cast<std::size_t>(length);
    if (opcode != static_cast<std::uint8_t>(McapOpcode::chunk)) return true;  // chunks do not nest
    left = ByteSpan(chunk_).subspan(chunk_at_);
  }
  if (!left.empty() && !chunk_cut_off_) {
    ++losses_.regions;
    losses_.bytes += left.size();
  }
  in_chunk_ = false;
  return false;
}

}  // namespace egocal::detail
