// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/trajectory_file.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/io/poses_as_given.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/printable.hpp"
#include "io/static_transform.hpp"
#include "io/stream_list.hpp"
#include "io/transform_chain.hpp"

namespace egocal {

namespace {

/// Where poses are put, in the order of the file, and their rows where they are asked for.
struct Taken {
  Trajectory& poses;
  std::vector<std::size_t>* rows;

  void add(const StampedPose& pose, const ReadLosses& losses_so_far) {
    if (rows) rows->push_back(poses.size() + losses_so_far.refused);
    poses.push_back(pose);
  }
  void clear() {
    poses.clear();
    if (rows) rows->clear();
  }
};

/// The poses of one stream, in the order of the file. A colon may be part of its name.
void read_stream(Recording& recording, const std::string& topic, Taken taken) {
  std::vector<signed char> wanted;  // by stream; -1: not looked at yet
  recording.read(topic, [&](std::size_t stream, const StampedPose& pose) {
    if (stream >= wanted.size()) wanted.resize(stream + 1, -1);
    if (wanted[stream] < 0) {
      const RecordedStream& from = recording.streams()[stream];
      wanted[stream] = from.name == topic && !from.fixed ? 1 : 0;
    }
    if (wanted[stream] == 1) taken.add(pose, recording.losses());
  });
}

/// tf1 wrote frames with a leading slash: "/odom/lidar" and "/odom//lidar" are "odom/lidar".
std::string without_slashes_of_tf1(std::string frames) {
  if (const std::size_t at = frames.find("//"); at != std::string::npos) frames.erase(at, 1);
  if (frames.starts_with('/')) frames.erase(0, 1);
  return frames;
}

/// FILE:/tf:PARENT/CHILD over several transforms; the streams are known from a first pass.
void read_chain(Recording& recording, const std::string& topic, TrajectoryReading& reading) {
  const std::vector<RecordedStream> streams = recording.streams();
  const std::string tf = topic.substr(0, topic.find(':'));
  const auto frames = detail::split_frames(streams, without_slashes_of_tf1(topic.substr(tf.size() + 1)));
  const auto links = frames ? detail::find_chain(streams, tf, frames->first, frames->second) : std::nullopt;
  if (!links)
    throw error_at(recording.file(), 0, printable(topic),
                   "no transforms lead from one frame to the other; " + detail::topics_in_words(streams));
  std::vector<TrajectoryReading> parts(links->size());
  std::vector<detail::StaticTransform> values(links->size());
  std::vector<bool> fixed(links->size());
  for (std::size_t i = 0; i < links->size(); ++i) {
    const RecordedStream& link = streams[(*links)[i].stream];
    fixed[i] = link.fixed;
    if (link.fixed) values[i] = detail::StaticTransform(link);
  }
  recording.read("", [&](std::size_t stream, const StampedPose& pose) {
    const RecordedStream& from = recording.streams()[stream];
    for (std::size_t i = 0; i < links->size(); ++i)
      if (fixed[i])
        values[i].add(from, pose);
      else if (from.name == streams[(*links)[i].stream].name)
        parts[i].trajectory.push_back(pose);
  });
  std::vector<Trajectory> poses;
  for (std::size_t i = 0; i < links->size(); ++i) {
    if (fixed[i]) parts[i].trajectory = values[i].value();
    if (std::string text = values[i].contradiction(); !text.empty())
      reading.contradictions.push_back(std::move(text));
    put_in_order(parts[i]);
    reading.out_of_order += parts[i].out_of_order;
    reading.duplicates += parts[i].duplicates;
    poses.push_back(std::move(parts[i].trajectory));
  }
  std::size_t dropped = 0;
  reading.trajectory = detail::resolve_chain(*links, fixed, poses, dropped);
  if (reading.trajectory.empty())
    throw error_at(recording.file(), 0, printable(topic),
                   dropped > 0 ? "the transforms of this chain never overlap in time"
                               : "all transforms of this chain are static: nothing moves");
  if (dropped > 0)
    reading.notes.push_back(std::to_string(dropped) +
                            " poses dropped: another transform of the chain has none near their time");
}

/// The name under which the stream is known: "odom" may be "/odom", and a tf topic with one moving transform
/// needs no frames.
std::string full_name(const std::vector<RecordedStream>& streams, const std::string& topic) {
  std::vector<std::string> transforms;
  for (const RecordedStream& stream : streams)
    if (stream.poses && !stream.fixed && stream.name != stream.topic &&
        (stream.topic == topic || stream.topic == "/" + topic))
      transforms.push_back(stream.name);
  if (transforms.size() == 1) return transforms.front();
  const auto known = [&](const std::string& name) {
    return std::any_of(streams.begin(), streams.end(), [&](const RecordedStream& stream) {
      return stream.name == name || stream.topic == name;
    });
  };
  if (!known(topic) && known("/" + topic)) return "/" + topic;
  const std::string head = topic.substr(0, topic.find(':'));
  return !topic.empty() && !known(head) && known("/" + head) ? "/" + topic : topic;
}

/// "/lidar: messages of several types are mixed: nav_msgs/Odometry (600), geometry_msgs/PoseStamped (300)";
/// empty: all are of one type.
std::string mixed_types(const std::vector<RecordedStream>& streams, const std::string& name) {
  std::string text;
  std::size_t types = 0;
  for (const RecordedStream& stream : streams) {
    if (stream.name != name || !stream.poses || stream.fixed || stream.messages == 0) continue;
    text +=
        (types++ == 0 ? "" : ", ") + printable(stream.type) + " (" + std::to_string(stream.messages) + ")";
  }
  return types > 1 ? printable(name) + ": messages of several types are mixed: " + text : "";
}

/// name: what was asked for; empty: the only stream. Text has one without a name.
Error no_pose(const Recording& recording, const std::string& name) {
  const std::vector<RecordedStream>& streams = recording.streams();
  const bool nameless = streams.size() == 1 && streams.front().name.empty();
  const std::string without = detail::why_no_poses(streams, name);
  return error_at(recording.file(), 0, printable(name),
                  (name.empty()       ? "holds no pose that can be read"
                   : !without.empty() ? without
                                      : "no pose under this name") +
                      (nameless ? "" : "; " + detail::topics_in_words(streams)) +
                      (recording.losses().any() ? "; " + losses_in_words(recording.losses()) : ""));
}

/// The poses of a stream in order. as_given: where not null, also those of the file; what was sorted and left
/// away is then not among the notes.
TrajectoryReading read_poses(Recording& recording, const std::string& topic, PosesOfFile* as_given) {
  TrajectoryReading reading;
  Taken taken{reading.trajectory, as_given ? &as_given->rows : nullptr};
  std::string name = topic;
  bool looked = false;
  if (name.empty()) {
    // the only stream with poses, where there is only one
    std::size_t first = SIZE_MAX;
    bool several = false;
    recording.read("", [&](std::size_t stream, const StampedPose& pose) {
      if (recording.streams()[stream].fixed) return;
      several = several || (first != SIZE_MAX && first != stream);
      first = std::min(first, stream);
      if (several)
        taken.clear();
      else
        taken.add(pose, recording.losses());
    });
    looked = true;
    if (several)
      throw error_at(recording.file(), 0, "",
                     "holds several streams, choose one with " + printable(recording.file()) + ":TOPIC; " +
                         detail::topics_in_words(recording.streams()));
    if (first != SIZE_MAX) name = recording.streams()[first].name;
  } else {
    read_stream(recording, name, taken);
    if (reading.trajectory.empty()) {
      name = full_name(recording.streams(), topic);
      if (name != topic) read_stream(recording, name, taken);
    }
  }
  const auto is_asked = [&](const RecordedStream& stream) { return stream.topic == name; };
  const std::vector<RecordedStream>& streams = recording.streams();
  const bool topic_with_colon = std::any_of(streams.begin(), streams.end(), is_asked);
  if (reading.trajectory.empty() && !looked && !topic_with_colon && name.find(':') != std::string::npos)
    read_chain(recording, name, reading);
  reading.losses = recording.losses();
  if (reading.trajectory.empty()) throw no_pose(recording, name);
  reading.format = recording.format();
  reading.has_scale = recording.has_scale();
  reading.stream = name;
  if (as_given) {
    if (as_given->rows.size() != reading.trajectory.size())
      as_given->rows = as_rows(reading.trajectory).rows;  // of a chain
    as_given->poses = reading.trajectory;
    as_given->count = reading.trajectory.size() + reading.losses.refused;
  }
  put_in_order(reading);
  for (const RecordedStream& stream : recording.streams())
    if (stream.name == name && !stream.mixed.empty())
      reading.contradictions.push_back(printable(name) + ": " + stream.mixed);
  if (std::string mixed = mixed_types(streams, name); !mixed.empty())
    reading.contradictions.push_back(std::move(mixed));
  reading.notes.insert(reading.notes.begin(), recording.notes().begin(), recording.notes().end());
  reading.notes.insert(reading.notes.end(), reading.contradictions.begin(), reading.contradictions.end());
  if (!as_given)
    for (std::string& repair : repairs_in_words(reading)) reading.notes.push_back(std::move(repair));
  if (reading.losses.any()) reading.notes.push_back(losses_in_words(reading.losses));
  return reading;
}

}  // namespace

void put_in_order(TrajectoryReading& reading) {
  Trajectory& poses = reading.trajectory;
  std::int64_t latest = INT64_MIN;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::int64_t time_us = poses[i].time_us;
    if (time_us < latest) ++reading.out_of_order;
    if (time_us <= latest && reading.first_repair.empty()) {
      char text[128];
      std::snprintf(text, sizeof text, "pose %zu, at %.6f s, %s", i + 1, to_seconds(time_us),
                    time_us < latest ? "comes after a later one" : "has the time of the one before it");
      reading.first_repair = text;
    }
    latest = std::max(latest, time_us);
  }
  if (reading.out_of_order > 0)
    std::stable_sort(poses.begin(), poses.end(),
                     [](const StampedPose& x, const StampedPose& y) { return x.time_us < y.time_us; });
  const auto same = [](const StampedPose& x, const StampedPose& y) { return x.time_us == y.time_us; };
  const auto end = std::unique(poses.begin(), poses.end(), same);
  reading.duplicates = static_cast<std::uint64_t>(poses.end() - end);
  poses.erase(end, poses.end());
}

void refuse_repairs(const std::string& name, const TrajectoryReading& reading) {
  if (!reading.first_repair.empty())
    throw error_at(name, 0, "",
                   reading.first_repair +
                       ", expected increasing times; without --strict such poses are sorted "
                       "and merged");
  if (reading.losses.any()) throw error_at(name, 0, "", losses_in_words(reading.losses));
  if (!reading.contradictions.empty()) throw error_at(name, 0, "", reading.contradictions.front());
}

TrajectoryReading read_trajectory_of(Recording& recording, const std::string& topic) {
  return read_poses(recording, topic, nullptr);
}

TrajectoryReading read_trajectory_of(Recording& recording, const std::string& topic, PosesOfFile& as_given) {
  as_given = {};
  return read_poses(recording, topic, &as_given);
}

std::vector<std::string> repairs_in_words(const TrajectoryReading& reading) {
  std::vector<std::string> repairs;
  if (reading.out_of_order > 0)
    repairs.push_back(counted(reading.out_of_order, "pose") + (reading.out_of_order == 1 ? " was" : " were") +
                      " out of order: sorted by time");
  if (reading.duplicates > 0)
    repairs.push_back(counted(reading.duplicates, "pose") + (reading.duplicates == 1 ? " has" : " have") +
                      " the time of another one: the first of each is kept");
  return repairs;
}

TrajectoryReading read_trajectory_file(const std::string& name, const ReadOptions& options) {
  const RecordingName parts = parse_recording_name(name);
  TrajectoryReading reading = read_trajectory_of(*open_recording(parts.file, options), parts.topic);
  if (options.strict) refuse_repairs(name, reading);
  return reading;
}

Trajectory read_trajectory(const std::string& name, const std::string& times_file) {
  ReadOptions options;
  options.times_file = times_file;
  return read_trajectory_file(name, options).trajectory;
}

}  // namespace egocal
