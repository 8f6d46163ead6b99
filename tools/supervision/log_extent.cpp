// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/log_extent.hpp"

#include <optional>

#include "egocal/bus/odometry.hpp"

namespace egocal::tools {

LogExtent log_extent(bus::LogReader& log, const bus::Rig& rig) {
  LogExtent extent;
  log.rewind();
  while (const std::optional<bus::LogEvent> event = log.next())
    for (const bus::Sensor& sensor : rig.sensors) {
      if (sensor.channel != event->channel) continue;
      const bus::ReceivedOdometry odometry = bus::decode_odometry(sensor, event->data);
      if (!odometry.decoded || !odometry.pose) continue;
      const std::int64_t time_us = odometry.pose.value->time_us;
      extent.sensors.try_emplace(sensor.name, LogExtent::Stream{time_us, time_us}).first->second.last_us =
          time_us;
    }
  extent.damage = log.damage();
  return extent;
}

}  // namespace egocal::tools
