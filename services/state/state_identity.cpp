// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "state/state_identity.hpp"

#include <cinttypes>
#include <cstdio>

#include "state/state_fields.hpp"

namespace egocal::services {

StateIdentity state_identity(const std::string& process, int layout, const bus::Rig& rig) {
  std::string text = process + " " EGOCAL_VERSION ", layout " + std::to_string(layout) + "\n";
  char line[320];
  for (const bus::Sensor& sensor : rig.sensors) {
    std::snprintf(line, sizeof line, "sensor %s on %s, %s, scale %.17g%s, reorder_window %g\n",
                  sensor.name.c_str(), sensor.channel.c_str(),
                  sensor.type == bus::OdometryType::pose ? "bot_core.pose_t" : "egocal.odometry_t",
                  sensor.scale, sensor.find_scale ? " and to be found" : "", rig.reorder_window);
    text += line;
  }
  for (const bus::PairConfig& pair : rig.pairs) {
    Writer settings;
    settings(bus::drive_options(rig, pair));
    std::snprintf(line, sizeof line, "pair %s %s with settings %016" PRIx64 "\n", pair.a.c_str(),
                  pair.b.c_str(), checksum(settings.bytes()));
    text += line;
  }
  return {process, text};
}

}  // namespace egocal::services
