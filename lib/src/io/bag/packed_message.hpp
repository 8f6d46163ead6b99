// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "io/bytes/byte_source.hpp"

namespace egocal::detail {

/// Messages that rosbag2 has compressed one by one (compression_mode: MESSAGE). They are recognised by their
/// first bytes, as files are: CDR begins with a zero byte, which no packed message does.
class PackedMessage {
 public:
  /// The unpacked message, or the message itself if it is not packed; valid until the next call. Empty: it is
  /// damaged, or longer than largest_record.
  std::optional<ByteSpan> unpacked(std::string_view encoding, ByteSpan message);

 private:
  std::unique_ptr<Unpacker> unpacker_;
  std::vector<unsigned char> out_;
};

}  // namespace egocal::detail
