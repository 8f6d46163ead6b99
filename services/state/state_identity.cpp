// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "state/state_identity.hpp"

#include <cinttypes>
#include <cstdio>

#include "state/state_fields.hpp"

namespace egocal::services {

namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

template <int n>
std::string numbers(const Eigen::Matrix<double, n, 1>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + number(value);
  return text;
}

/// A line for each setting that a rig file may name, so that one that differs is named. The last line is of
/// all settings, also those that are of the program.
std::string settings_of(const bus::Rig& rig, const bus::PairConfig& pair) {
  const PairingOptions options = bus::drive_options(rig, pair);
  std::string text;
  const auto line = [&](const std::string& setting) {
    text += "pair " + pair.a + " " + pair.b + ": " + setting + "\n";
  };
  line(options.mode == Mode::planar
           ? "mode planar on " + numbers(options.plane_a.normal) + " " + number(options.plane_a.distance) +
                 " and " + numbers(options.plane_b.normal) + " " + number(options.plane_b.distance)
           : "mode spatial");
  line("stride " + (options.stride ? std::to_string(*options.stride) : "auto"));
  line("balance " + (options.balance
                         ? number(options.balance->rotation) + ":" + number(options.balance->translation)
                         : "auto"));
  line("robust " + std::string(options.robust ? "true" : "false"));
  line("time_offset " + (options.track_time_offset ? "auto" : number(options.time_offset)));
  line("max_gap " + number(options.max_gap));
  line("nominal " + (pair.nominal ? numbers(options.prior->vec()) : "none"));
  Writer settings;
  settings(options);
  char all[32];
  std::snprintf(all, sizeof all, "%016" PRIx64, checksum(settings.bytes()));
  line("all settings " + std::string(all));
  return text;
}

}  // namespace

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
  for (const bus::PairConfig& pair : rig.pairs) text += settings_of(rig, pair);
  return {process, text};
}

}  // namespace egocal::services
