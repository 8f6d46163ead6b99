// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A text through the reader of rig files.
#include <cmath>
#include <string>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "require.hpp"

using namespace egocal;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const bus::Rig rig = bus::parse_rig(std::string(reinterpret_cast<const char*>(data), size), "rig.toml");
    require(!rig.sensors.empty() && !rig.pairs.empty(), "a rig has sensors and pairs");
    for (const bus::Sensor& sensor : rig.sensors) {
      require(bus::plausible_name(sensor.name), "sensors have names");
      require(!sensor.channel.empty() && sensor.channel.size() <= 63, "and channels that LCM takes");
      require(!sensor.plane || std::abs(sensor.plane->normal.norm() - 1) < 1e-6, "a plane has a unit normal");
    }
    for (const bus::PairConfig& pair : rig.pairs) {
      require(pair.a != pair.b, "a pair is of two sensors");
      require(!pair.nominal || std::abs(pair.nominal->rotation.norm() - 1) < 1e-9, "a rotation is one");
      require(!pair.time_offset || std::isfinite(*pair.time_offset), "an offset is finite");
      require(!pair.stride || (*pair.stride >= 1 && *pair.stride <= 10000), "a stride is one");
      require(
          pair.mode == Mode::spatial || (bus::sensor(rig, pair.a).plane && bus::sensor(rig, pair.b).plane),
          "planar pairs have planes");
    }
  } catch (const Error& error) {
    fuzz::require_one_line(error.what());
  }
  return 0;
}
