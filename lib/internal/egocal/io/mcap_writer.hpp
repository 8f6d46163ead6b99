// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// Writes poses and transforms as an MCAP file that ROS 2 and Foxglove open: chunks packed by zstd, with
/// checksums, message indexes and a summary. The file takes its name when close() is called; without that
/// nothing remains. Memory: one chunk, and 40 bytes a chunk.
class McapWriter {
 public:
  explicit McapWriter(const std::string& file);  ///< throws Error
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// geometry_msgs/PoseStamped on a topic. Times in a topic may come in any order. Throws Error where the
  /// disk is full, or the topic is the 65,536th.
  void write_pose(const std::string& topic, const std::string& frame, const StampedPose& pose);
  /// Writes a tf2_msgs/TFMessage with the pose of `child` in `parent`, on /tf.
  void write_transform(const std::string& parent, const std::string& child, const StampedPose& pose);
  void close();  ///< throws Error

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace egocal
