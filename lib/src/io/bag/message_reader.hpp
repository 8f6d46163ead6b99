// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "egocal/io/trajectory_file.hpp"
#include "io/bytes/byte_source.hpp"

namespace egocal::detail {

/// Largest chunk, record or message that is held in memory [bytes]; larger ones count as damaged.
inline constexpr std::size_t largest_record = 64 << 20;

struct BagTopic {
  std::string name;
  std::string type;      ///< ROS 1 style: "nav_msgs/Odometry"
  std::string encoding;  ///< of its messages: "cdr" or "ros1"; others are counted, not decoded
};

struct BagMessage {
  std::size_t topic = 0;         ///< index in topics()
  std::int64_t log_time_ns = 0;  ///< when it was recorded [ns]
  ByteSpan data;                 ///< valid until the next call of next()
};

/// The messages of a bag in the order of the file, one at a time, in constant memory. Damaged regions are
/// skipped and counted.
class MessageReader {
 public:
  virtual ~MessageReader() = default;
  /// Reads the next message; false at the end.
  virtual bool next(BagMessage& message) = 0;
  virtual void rewind() = 0;
  /// Topics met so far: they grow while messages are read.
  const std::vector<BagTopic>& topics() const { return topics_; }
  const ReadLosses& losses() const { return losses_; }

 protected:
  std::vector<BagTopic> topics_;
  ReadLosses losses_;
};

/// "nav_msgs/msg/Odometry" (ROS 2) to "nav_msgs/Odometry".
std::string ros1_type_name(const std::string& type);

}  // namespace egocal::detail
