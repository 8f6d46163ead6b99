// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/reading/trajectory_source.hpp"

#include <utility>

#include "egocal/error.hpp"
#include "offline/reading/lcm_recording.hpp"
#include "offline/reading/log_trajectory.hpp"
#include "offline/reading/pipe_notice.hpp"
#include "offline/reading/poses_as_given.hpp"

namespace egocal::tools {

std::unique_ptr<Recording> open_any_recording(const std::string& file, const ReadOptions& options) {
  if (is_lcm_log(file)) return std::make_unique<LcmRecording>(file);
  const PipeNotice notice(file);
  return open_recording(file, options);
}

namespace {

TrajectoryReading read_any(const std::string& name, const ReadOptions& options, PosesOfFile* as_given) {
  const RecordingName parts = parse_recording_name(name);
  const auto with = [](TrajectoryReading reading, const std::vector<std::string>& notes) {
    reading.notes.insert(reading.notes.end(), notes.begin(), notes.end());
    return reading;
  };
  if (!is_lcm_log(parts.file) || parts.topic.empty()) {
    const std::unique_ptr<Recording> recording = open_any_recording(parts.file, options);
    TrajectoryReading reading = as_given ? read_trajectory_of(*recording, parts.topic, *as_given)
                                         : read_trajectory_of(*recording, parts.topic);
    if (options.strict) refuse_repairs(name, reading);
    return with(std::move(reading), recording->unused(options));
  }
  // live odometry and its log pass the same checks
  LogTrajectory log = read_log_trajectory(parts.file, parts.topic);
  TrajectoryReading reading;
  reading.trajectory = std::move(log.poses);
  if (as_given) *as_given = as_rows(reading.trajectory);
  reading.format = "LCM log";
  reading.stream = parts.topic;
  for (std::string* note : {&log.not_used, &log.damage})
    if (!note->empty()) reading.notes.push_back(std::move(*note));
  if (options.strict && !reading.notes.empty()) throw error_at(name, 0, "", reading.notes.front());
  if (!log.times.empty()) reading.notes.push_back(log.times);
  return with(std::move(reading), unused_by_messages(options));
}

}  // namespace

TrajectoryReading read_any_trajectory(const std::string& name, const ReadOptions& options) {
  return read_any(name, options, nullptr);
}

PosesAsGiven read_as_given(const std::string& name, const ReadOptions& options) {
  PosesAsGiven poses;
  const TrajectoryReading reading = read_any(name, options, &poses.list);
  poses.has_scale = reading.has_scale;
  for (const std::string& note : reading.notes) poses.notes.push_back(name + ": " + note);
  for (const std::string& repair : repairs_in_words(reading)) poses.repairs.push_back(name + ": " + repair);
  return poses;
}

Trajectory read_noting(const std::string& name, const ReadOptions& options,
                       std::vector<std::string>& warnings, bool* has_scale) {
  TrajectoryReading reading = read_any_trajectory(name, options);
  if (has_scale) *has_scale = reading.has_scale;
  for (const std::string& note : reading.notes) warnings.push_back(name + ": " + note);
  return std::move(reading.trajectory);
}

}  // namespace egocal::tools
