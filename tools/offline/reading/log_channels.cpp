// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/reading/log_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/error.hpp"
#include "offline/reading/channel_list.hpp"

namespace egocal::tools {

namespace {

bool is_a_pose_of(const bus::Sensor& sensor, const bus::LogEvent& event) {
  if (sensor.type == bus::OdometryType::pose) {
    bot_core::pose_t pose{};
    return bus::decode(event.data, pose);
  }
  odometry_t odometry{};
  return bus::decode(event.data, odometry);
}

}  // namespace

void require_a_pair(const std::string& log, const bus::Rig& rig) {
  bus::LogReader reader(log);
  std::set<std::string> sensors, of_another_type;
  ChannelList channels;
  while (const std::optional<bus::LogEvent> event = reader.next()) {
    channels.add(event->channel);
    for (const bus::Sensor& sensor : rig.sensors) {
      if (sensor.channel != event->channel || sensors.contains(sensor.name)) continue;
      (is_a_pose_of(sensor, *event) ? sensors : of_another_type).insert(sensor.name);
      if (std::any_of(rig.pairs.begin(), rig.pairs.end(), [&](const bus::PairConfig& pair) {
            return sensors.contains(pair.a) && sensors.contains(pair.b);
          }))
        return;
    }
  }
  for (const bus::Sensor& sensor : rig.sensors) {
    if (sensors.contains(sensor.name)) continue;
    const std::string what = of_another_type.contains(sensor.name)
                                 ? "holds messages of another type than the rig says"
                                 : "is not in the log; there are: " + channels.text();
    throw error_at(log, 0, sensor.channel, fmt::format("the channel of sensor '{}' {}", sensor.name, what));
  }
}

}  // namespace egocal::tools
