// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig/settings.hpp"

#include <algorithm>

#include "arguments.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "egocal/online/nominal_part.hpp"

namespace egocal::tools {

namespace {

void refuse_unknown_scales(const bus::Rig& rig) {
  for (const bus::Sensor& sensor : rig.sensors)
    if (sensor.find_scale)
      throw Error(rig.file + ": sensor \"" + sensor.name +
                  "\": scale = \"auto\" is found for two sensors at a time: find it with solve A B --scale "
                  "auto, and put the number there");
}

/// The sensors of the rig that have a source.
std::vector<const bus::Sensor*> sensors_with_source(const bus::Rig& rig, const RigRequest& request,
                                                    RigSettings& settings) {
  if (request.from.empty() == request.log.empty())
    throw UsageError("--rig: expected --from NAME=FILE for its sensors, or --log FILE");
  std::vector<const bus::Sensor*> sensors;
  const auto take = [&](const bus::Sensor& sensor, const std::string& source) {
    sensors.push_back(&sensor);
    settings.names.push_back(sensor.name);
    settings.sources.push_back(source);
    settings.scales.push_back(sensor.scale);
  };
  for (const std::string& text : request.from) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      throw UsageError("--from: expected NAME=FILE, got '" + text + "'");
    const std::string name = text.substr(0, equals);
    if (std::find(settings.names.begin(), settings.names.end(), name) != settings.names.end())
      throw UsageError("--from: the sensor " + name +
                       " is given twice; another drive of all sensors goes with --append");
    take(bus::sensor(rig, name), text.substr(equals + 1));
  }
  if (!request.log.empty())
    for (const bus::Sensor& sensor : rig.sensors) take(sensor, sensor.channel);
  return sensors;
}

/// The pair of these sensors as the file lists it, or the other way round.
const bus::PairConfig* listed_pair(const bus::Rig& rig, const std::string& a, const std::string& b) {
  for (const bus::PairConfig& pair : rig.pairs)
    if ((pair.a == a && pair.b == b) || (pair.a == b && pair.b == a)) return &pair;
  return nullptr;
}

/// What the command line chose stays, as for two sensors.
void take_from_pair(const bus::Rig& rig, const bus::PairConfig& pair, bool turned,
                    const CalibrationOptions& common, RigPairSettings& settings) {
  const auto towards_a = [turned](const Pose& T) { return turned ? inverse(T) : T; };
  bus::PairConfig whole = pair;
  if (whole.nominal && is_part(*whole.nominal)) {
    settings.nominal_part = whole.nominal;
    whole.nominal.reset();
  }
  settings.turned = turned;
  const PairingOptions of_file = bus::drive_options(rig, whole);
  PairingOptions& pairing = settings.calibration.pairing;
  pairing.mode = of_file.mode;
  pairing.plane_a = turned ? of_file.plane_b : of_file.plane_a;
  pairing.plane_b = turned ? of_file.plane_a : of_file.plane_b;
  const bool weights_typed = common.pairing.balance || !common.pairing.robust;
  if (!common.pairing.stride) pairing.stride = of_file.stride;
  if (!weights_typed) {
    pairing.balance = of_file.balance;
    pairing.robust = of_file.robust;
  }
  if (whole.nominal) pairing.prior = to_dual_quaternion(towards_a(*whole.nominal));
  if (pair.truth) settings.truth = towards_a(*pair.truth);
  settings.calibration.diagnosis.goal = pair.goal;
  settings.calibration.diagnosis.platform = pair.platform;
  settings.listed = true;
  settings.time_offset = pair.time_offset;
  if (turned && settings.time_offset) settings.time_offset = -*settings.time_offset;
}

}  // namespace

RigSettings rig_settings(const RigRequest& request) {
  RigSettings settings;
  settings.names = request.names;
  settings.sources = request.sources;
  settings.scales.assign(request.sources.size(), 1);
  CalibrationOptions common = request.calibration;
  common.estimate_time_offset = false;
  common.pairing.time_offset = 0;
  bus::Rig rig;
  std::vector<const bus::Sensor*> sensors;
  if (!request.rig.empty()) {
    rig = bus::read_rig(request.rig);
    refuse_unknown_scales(rig);
    sensors = sensors_with_source(rig, request, settings);
    common.pairing.max_gap = rig.max_gap;
  }
  if (settings.sources.size() < 2) throw UsageError("solve: expected two sensors at least");
  bool all_planar = !rig.pairs.empty();
  for (const bus::PairConfig& pair : rig.pairs) all_planar = all_planar && pair.mode == Mode::planar;
  for (const bus::Sensor* sensor : sensors)
    if (sensor->plane) settings.planes.push_back(*sensor->plane);
  if (!all_planar || settings.planes.size() != settings.names.size()) settings.planes.clear();
  for (std::size_t a = 0; a < settings.names.size(); ++a)
    for (std::size_t b = a + 1; b < settings.names.size(); ++b) {
      RigPairSettings pair;
      pair.a = a;
      pair.b = b;
      pair.calibration = common;
      if (!settings.planes.empty()) {
        pair.calibration.pairing.mode = Mode::planar;
        pair.calibration.pairing.plane_a = settings.planes[a];
        pair.calibration.pairing.plane_b = settings.planes[b];
      }
      if (const bus::PairConfig* listed = listed_pair(rig, settings.names[a], settings.names[b]))
        take_from_pair(rig, *listed, listed->a != settings.names[a], common, pair);
      settings.pairs.push_back(std::move(pair));
    }
  // one look at one rig: the false alarms of its pairs add up
  for (RigPairSettings& pair : settings.pairs)
    pair.calibration.diagnosis.mount.false_alarms /= static_cast<double>(settings.pairs.size());
  return settings;
}

}  // namespace egocal::tools
