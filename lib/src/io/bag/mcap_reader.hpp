// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "io/bag/mcap_records.hpp"
#include "io/bag/message_reader.hpp"

namespace egocal::detail {

/// The messages of an MCAP file (ROS 2's default, Foxglove).
class McapReader : public MessageReader {
 public:
  explicit McapReader(std::unique_ptr<ByteSource> source) : records_(std::move(source)) {}

  bool next(BagMessage& message) override;
  void rewind() override;

 private:
  void take_schema(ByteSpan content);
  void take_channel(ByteSpan content);

  McapRecords records_;
  std::map<std::uint16_t, std::string> schemas_;   ///< names by id
  std::map<std::uint16_t, std::size_t> channels_;  ///< topic by id
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t>
      known_;                  ///< topics, by all of them
  std::uint64_t orphans_ = 0;  ///< messages of channels that were never announced
};

}  // namespace egocal::detail
