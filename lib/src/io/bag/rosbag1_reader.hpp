// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/bag/message_reader.hpp"

namespace egocal::detail {

inline constexpr std::string_view rosbag1_magic{"#ROSBAG V2.0\n"};

/// The messages of a ROS 1 bag, format 2.0, chunks packed with none, bz2 or lz4. Indexes are not needed: bags
/// of a recorder that was killed (.bag.active) are read, too.
class Rosbag1Reader : public MessageReader {
 public:
  /// Throws Error where the file does not begin with the magic line.
  explicit Rosbag1Reader(std::unique_ptr<ByteSource> source);

  bool next(BagMessage& message) override;
  void rewind() override;

 private:
  struct Record;
  bool next_in_file(Record& record);
  bool next_in_chunk(Record& record);
  void open_chunk(const Record& record, bool cut_off);
  bool find_next_record();
  void take_connection(const Record& record);

  std::unique_ptr<ByteSource> source_;
  std::unique_ptr<Unpacker> bz2_, lz4_;
  std::vector<unsigned char> chunk_;
  std::size_t chunk_at_ = 0;
  bool in_chunk_ = false, chunk_cut_off_ = false;
  std::size_t pending_ = 0;                                           ///< bytes of the record handed out last
  std::map<std::uint32_t, std::size_t> connections_;                  ///< topic by id
  std::map<std::pair<std::string, std::string>, std::size_t> known_;  ///< topics by name and type
};

}  // namespace egocal::detail
