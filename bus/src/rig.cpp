// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/rig.hpp"

#include "egocal/error.hpp"
#include "egocal/online/nominal_part.hpp"

namespace egocal::bus {

const Sensor& sensor(const Rig& rig, const std::string& name) {
  for (const Sensor& s : rig.sensors)
    if (s.name == name) return s;
  throw error_at(rig.file, 0, "", "no sensor has the name \"" + name + "\"");
}

namespace {

/// Spreads the pairs of a rig over time: they estimate their clocks and choose their weights one after the
/// other.
double phase_of(const Rig& rig, const PairConfig& pair) {
  double before = 0;
  for (const PairConfig& other : rig.pairs) {
    if (other.a == pair.a && other.b == pair.b) return before / static_cast<double>(rig.pairs.size());
    before += 1;
  }
  return 0;
}

}  // namespace

PairingOptions drive_options(const Rig& rig, const PairConfig& pair) {
  PairingOptions options;
  options.mode = pair.mode;
  if (pair.mode == Mode::planar) {
    options.plane_a = sensor(rig, pair.a).plane.value_or(GroundPlane{});
    options.plane_b = sensor(rig, pair.b).plane.value_or(GroundPlane{});
  }
  options.stride = pair.stride;
  options.balance = pair.balance;
  options.time_offset = pair.time_offset.value_or(0);
  options.track_time_offset = !pair.time_offset;
  options.robust = pair.robust;
  options.max_gap = rig.max_gap;
  if (pair.nominal && is_part(*pair.nominal))
    throw error_at(rig.file, 0, "",
                   "pair \"" + pair.a + "\", \"" + pair.b +
                       "\": nominal: a part of it (nan) is for solve --rig; live all of it is needed");
  if (pair.nominal) options.prior = to_dual_quaternion(*pair.nominal);
  options.clock.phase = options.accumulator.choice_phase = phase_of(rig, pair);
  return options;
}

StreamOptions stream_options(const Rig& rig) {
  StreamOptions options;
  options.reorder_window = rig.reorder_window;
  return options;
}

std::optional<Side> unscaled_side(const Rig& rig, const PairConfig& pair) {
  for (const Sensor& s : rig.sensors)
    if (s.find_scale && (s.name == pair.a || s.name == pair.b)) return s.name == pair.a ? Side::a : Side::b;
  return std::nullopt;
}

}  // namespace egocal::bus
