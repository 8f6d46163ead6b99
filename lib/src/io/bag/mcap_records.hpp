// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/io/trajectory_file.hpp"
#include "io/bytes/byte_source.hpp"

namespace egocal::detail {

inline constexpr std::string_view mcap_magic{"\x89MCAP0\r\n", 8};

/// Opcodes of the MCAP specification that matter here.
enum class McapOpcode : std::uint8_t {
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  data_end = 0x0f,
};

struct McapRecord {
  std::uint8_t opcode = 0;
  ByteSpan content;  ///< valid until the next call of next()
};

/// The records of an MCAP file in the order of the file, those inside chunks in place of the chunk. The
/// summary is read like the rest, indexes are not needed. Chunks whose checksum differs are skipped; after a
/// damaged record reading continues at the next one whose lengths fit. Records above 64 MiB that are no
/// chunks or messages (attachments) are passed over.
class McapRecords {
 public:
  /// Throws Error if the file does not begin with the magic bytes.
  explicit McapRecords(std::unique_ptr<ByteSource> source);

  bool next(McapRecord& record);
  void rewind();
  const ReadLosses& losses() const { return losses_; }

 private:
  bool next_in_file(McapRecord& record);
  bool next_in_chunk(McapRecord& record);
  void open_chunk(ByteSpan content, bool cut_off);
  void consume(std::size_t size);
  bool find_next_record();

  std::unique_ptr<ByteSource> source_;
  std::unique_ptr<Unpacker> zstd_, lz4_;
  std::vector<unsigned char> chunk_;
  std::size_t chunk_at_ = 0;
  bool in_chunk_ = false, chunk_cut_off_ = false;
  std::size_t pending_ = 0;  ///< bytes of the record handed out last, still to be consumed
  std::uint32_t data_crc_ = 0;
  bool crc_usable_ = true;  ///< every byte of the data section has passed through it
  ReadLosses losses_;
};

}  // namespace egocal::detail
