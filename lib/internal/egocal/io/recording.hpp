// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "egocal/io/trajectory_file.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// One stream of a recording: a topic of a bag, one transform of a tf topic, a channel of a log, or the only
/// one of a text file.
struct RecordedStream {
  std::string name;            ///< what follows the file and a colon; empty where the file holds only one
  std::string type;            ///< of its messages, e.g. "nav_msgs/Odometry"
  std::uint64_t messages = 0;  ///< read so far
  bool poses = false;          ///< whether poses can be taken from it
  std::string topic, parent, child;  ///< of a transform on a tf topic: topic and frames
  bool fixed = false;                ///< a static transform
  /// "poses of several frames are mixed: map (600), odom (600)"; empty: all are of one frame.
  std::string mixed;
  std::string unknown_encoding;  ///< of messages that cannot be decoded, e.g. "json"; empty: they can
};

/// What messages of a bag or log do not need: they name their fields and have times.
std::vector<std::string> unused_by_messages(const ReadOptions& options);

/// A file with poses, whatever its format, behind one interface. Reading is streaming: memory does not grow
/// with the file, except by the names of its streams. Not thread-safe; different objects are independent.
class Recording {
 public:
  using TakePose = std::function<void(std::size_t stream, const StampedPose& pose)>;

  virtual ~Recording() = default;

  /// Name of the format: "TUM", "MCAP", ...
  virtual std::string format() const = 0;
  /// Whether lengths are meant to be metres.
  virtual bool has_scale() const { return true; }
  /// One pass over the whole file: every pose in the order of the file. Damaged places are skipped and
  /// counted. `topic`, where not empty, limits the work to streams of that name or topic. Throws Error where
  /// the file cannot be read at all.
  virtual void read(const std::string& topic, const TakePose& take) = 0;

  const std::string& file() const { return file_; }
  /// Streams that the last pass has met; all of them after a pass over everything.
  const std::vector<RecordedStream>& streams() const { return streams_; }
  /// What the last pass has lost.
  const ReadLosses& losses() const { return losses_; }
  /// What was assumed about the file, one sentence each: units, rate, order of columns.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Options that had no effect on the last pass, one sentence each.
  virtual std::vector<std::string> unused(const ReadOptions& options) const {
    return unused_by_messages(options);
  }

 protected:
  explicit Recording(std::string file) : file_(std::move(file)) {}

  std::string file_;
  std::vector<RecordedStream> streams_;
  ReadLosses losses_;
  std::vector<std::string> notes_;
};

/// Opens a file by its content: MCAP, rosbag 1 and 2, or text (TUM, KITTI, EuRoC, tables with named columns),
/// each also as .gz, .zst, .bz2 or .lz4. A folder, or the metadata.yaml in it, is taken as a bag of rosbag2.
/// Throws Error where the file cannot be opened, or is known and not readable.
std::unique_ptr<Recording> open_recording(const std::string& file, const ReadOptions& options = {});

/// "drive.mcap:/lidar/odom" in its parts. A colon that belongs to the name of an existing file stays there.
struct RecordingName {
  std::string file, topic;
};
RecordingName parse_recording_name(const std::string& text);

/// Reads a trajectory as read_trajectory_file() does, from a recording that is open already.
TrajectoryReading read_trajectory_of(Recording& recording, const std::string& topic);

/// Sorts by time and keeps the first of equal times; counts both.
void put_in_order(TrajectoryReading& reading);

/// ReadOptions::strict: throws Error naming the recording and the first pose that was put in order, what was
/// lost, or the first contradiction.
void refuse_repairs(const std::string& name, const TrajectoryReading& reading);

}  // namespace egocal
