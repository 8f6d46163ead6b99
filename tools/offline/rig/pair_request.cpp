// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig/pair_request.hpp"

#include <optional>

namespace egocal::tools {

SolveRequest request_of_pair(const bus::Rig& rig, const bus::PairConfig& pair, const std::string& log) {
  const bus::Sensor &a = bus::sensor(rig, pair.a), &b = bus::sensor(rig, pair.b);
  SolveRequest request;
  request.source.log = log;
  request.source.a = a.channel;
  request.source.b = b.channel;
  request.truth = pair.truth;
  CalibrationOptions& calibration = request.calibration;
  calibration.pairing = bus::drive_options(rig, pair);
  calibration.read_a.scale = a.scale;
  calibration.read_b.scale = b.scale;
  calibration.diagnosis.goal = pair.goal;
  calibration.diagnosis.platform = pair.platform;
  if (const std::optional<Side> side = bus::unscaled_side(rig, pair)) {
    calibration.estimate_scale = true;
    calibration.scale_side = *side;
    request.scale_option = *side == Side::a ? "--scale-a" : "--scale-b";
  }
  return request;
}

}  // namespace egocal::tools
