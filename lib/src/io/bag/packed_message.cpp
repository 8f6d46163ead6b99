// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bag/packed_message.hpp"

#include "io/bag/message_reader.hpp"

namespace egocal::detail {

std::optional<ByteSpan> PackedMessage::unpacked(std::string_view encoding, ByteSpan message) {
  if (encoding != "cdr" || message.empty() || message.front() == 0) return message;
  const std::string_view begin(reinterpret_cast<const char*>(message.data()), message.size());
  constexpr std::string_view zstd = "\x28\xb5\x2f\xfd", lz4 = "\x04\x22\x4d\x18";
  if (!begin.starts_with(zstd) && !begin.starts_with(lz4)) return message;
  unpacker_ = make_unpacker(message.first(4));
  if (!unpack_all(*unpacker_, message, largest_record, out_)) return std::nullopt;
  return ByteSpan(out_);
}

}  // namespace egocal::detail
