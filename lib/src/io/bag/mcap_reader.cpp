// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bag/mcap_reader.hpp"

#include "io/bytes/little_endian.hpp"

namespace egocal::detail {

std::string ros1_type_name(const std::string& type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string::npos ? type : type.substr(0, at) + type.substr(at + 4);
}

void McapReader::rewind() {
  records_.rewind();
  schemas_.clear();
  channels_.clear();
  orphans_ = 0;
}

void McapReader::take_schema(ByteSpan content) {
  LittleEndian from(content);
  const std::uint16_t id = from.u16();
  const std::string name(from.text());
  if (from.ok()) schemas_[id] = ros1_type_name(name);
}

void McapReader::take_channel(ByteSpan content) {
  LittleEndian from(content);
  const std::uint16_t id = from.u16(), schema = from.u16();
  const std::string topic(from.text());
  const std::string encoding(from.text());
  if (!from.ok()) return;
  const auto type = schemas_.find(schema);
  const std::string type_name = type == schemas_.end() ? "" : type->second;
  // the summary and later chunks repeat the channels, and several channels may share one topic
  const auto [entry, fresh] = known_.try_emplace({topic, type_name, encoding}, topics_.size());
  if (fresh) topics_.push_back({topic, type_name, encoding});
  channels_[id] = entry->second;
}

bool McapReader::next(BagMessage& message) {
  McapRecord record;
  bool found = false;
  while (!found && records_.next(record)) {
    if (record.opcode == static_cast<std::uint8_t>(McapOpcode::schema)) take_schema(record.content);
    if (record.opcode == static_cast<std::uint8_t>(McapOpcode::channel)) take_channel(record.content);
    if (record.opcode != static_cast<std::uint8_t>(McapOpcode::message)) continue;
    LittleEndian from(record.content);
    const auto channel = channels_.find(from.u16());
    from.u32();  // sequence
    message.log_time_ns = static_cast<std::int64_t>(from.u64());
    from.u64();  // publish time
    if (!from.ok() || channel == channels_.end()) {
      ++orphans_;
      continue;
    }
    message.topic = channel->second;
    message.data = from.take(from.left());
    found = true;
  }
  losses_ = records_.losses();
  losses_.regions += orphans_;
  return found;
}

}  // namespace egocal::detail
