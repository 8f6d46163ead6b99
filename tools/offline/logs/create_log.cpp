// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/logs/create_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/microseconds.hpp"
#include "offline/reading/trajectory_source.hpp"
#include "progress.hpp"

namespace egocal::tools {

namespace {

struct Entry {
  const bus::Sensor* sensor;
  std::int64_t seq;
  const StampedPose* pose;
};

/// The poses of all sensors in the order of time.
std::vector<Entry> in_order(const std::vector<const bus::Sensor*>& sensors,
                            const std::vector<Trajectory>& trajectories) {
  std::vector<Entry> entries;
  for (std::size_t k = 0; k < trajectories.size(); ++k)
    for (std::size_t i = 0; i < trajectories[k].size(); ++i)
      entries.push_back({sensors[k], static_cast<std::int64_t>(i), &trajectories[k][i]});
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& x, const Entry& y) { return x.pose->time_us < y.pose->time_us; });
  return entries;
}

/// Warns of each pair whose sensors share no time: nothing of it can be paired, and a player waits in
/// between.
void warn_of_times_apart(const bus::Rig& rig, const std::vector<const bus::Sensor*>& sensors,
                         const std::vector<Trajectory>& trajectories, std::vector<std::string>& warnings) {
  const auto poses_of = [&](const std::string& name) -> const Trajectory* {
    for (std::size_t k = 0; k < sensors.size(); ++k)
      if (sensors[k]->name == name && !trajectories[k].empty()) return &trajectories[k];
    return nullptr;
  };
  for (const bus::PairConfig& pair : rig.pairs) {
    const Trajectory *a = poses_of(pair.a), *b = poses_of(pair.b);
    if (!a || !b) continue;
    const std::int64_t apart_us =
        std::max(a->front().time_us, b->front().time_us) - std::min(a->back().time_us, b->back().time_us);
    if (apart_us > 0)
      warnings.push_back(fmt::format(
          "{} and {} share no time: {:.1f} s lie between their poses, and the player waits that long", pair.a,
          pair.b, to_seconds(apart_us)));
  }
}

/// shift_us: added to all times.
void write(const std::vector<Entry>& entries, std::int64_t shift_us, const std::string& out) {
  bus::LogWriter log(out);
  Progress progress("writing");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    StampedPose pose = *entries[i].pose;
    pose.time_us += shift_us;
    if (entries[i].sensor->type == bus::OdometryType::pose)
      log.write(pose.time_us, entries[i].sensor->channel, bus::encode(bus::to_pose_message(pose)));
    else
      log.write(pose.time_us, entries[i].sensor->channel, bus::encode(bus::to_message(pose, entries[i].seq)));
    progress(static_cast<double>(i + 1) / static_cast<double>(entries.size()));
  }
  log.close();
}

}  // namespace

std::vector<std::string> create_log(const std::string& rig_file, const std::vector<SensorFile>& from,
                                    const ReadOptions& reading, const std::string& out) {
  const bus::Rig rig = bus::read_rig(rig_file);
  std::vector<std::string> warnings;
  std::vector<const bus::Sensor*> sensors;
  std::vector<Trajectory> trajectories;
  std::set<std::string> given;
  for (const SensorFile& one : from) {
    given.insert(one.sensor);
    sensors.push_back(&bus::sensor(rig, one.sensor));
    trajectories.push_back(read_noting(one.file, reading, warnings));
  }
  for (const bus::Sensor& sensor : rig.sensors)
    if (!given.contains(sensor.name))
      warnings.push_back("no --from of the sensor " + sensor.name + ": its channel " + sensor.channel +
                         " is not in the log");
  warn_of_times_apart(rig, sensors, trajectories, warnings);
  const std::vector<Entry> entries = in_order(sensors, trajectories);
  // Times that begin near zero are no dates; on the wire they must be plausible ones.
  const std::int64_t first_us = entries.front().pose->time_us,
                     shift_us = bus::plausible_time(first_us) ? 0 : 1'700'000'000'000'000 - first_us;
  write(entries, shift_us, out);
  if (shift_us != 0)
    warnings.push_back(fmt::format("times do not begin after 1970; {:.3f} s were added to all of them",
                                   to_seconds(shift_us)));
  return warnings;
}

}  // namespace egocal::tools
