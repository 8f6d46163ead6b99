// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/trajectory_source.hpp"

#include "offline/lcm_recording.hpp"
#include "offline/log_trajectory.hpp"

namespace egocal::tools {

std::unique_ptr<Recording> open_any_recording(const std::string& file, const ReadOptions& options) {
  if (is_lcm_log(file)) return std::make_unique<LcmRecording>(file);
  return open_recording(file, options);
}

TrajectoryReading read_any_trajectory(const std::string& name, const ReadOptions& options) {
  const RecordingName parts = parse_recording_name(name);
  if (!is_lcm_log(parts.file) || parts.topic.empty())
    return read_trajectory_of(*open_any_recording(parts.file, options), parts.topic);
  // live odometry and its log pass the same checks
  LogTrajectory log = read_log_trajectory(parts.file, parts.topic);
  TrajectoryReading reading;
  reading.trajectory = std::move(log.poses);
  reading.format = "LCM log";
  reading.stream = parts.topic;
  if (!log.not_used.empty()) reading.notes.push_back(log.not_used);
  return reading;
}

}  // namespace egocal::tools
