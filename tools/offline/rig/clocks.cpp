// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig/clocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "egocal/error.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/pairing/time_offset.hpp"

namespace egocal::tools {

namespace {

/// Offsets of pairs that close a loop may differ by this [s]: what is found is not known to better
/// (ClockOptions::least_change).
constexpr double least_contradiction = 5e-3;

/// Sensors on one clock so far.
struct Clocks {
  const Drives& drives;
  std::vector<ClockOfSensor> of_sensor;
  std::vector<bool> known;
  std::vector<bool> not_found;  ///< from none of those that it was compared with
  std::size_t groups = 1;

  void begin_group(std::size_t sensor) {
    known[sensor] = true;
    of_sensor[sensor].group = groups++;
  }
};

void put(std::size_t sensor, double offset, std::vector<Trajectory>& trajectories, Clocks& clocks) {
  for (StampedPose& pose : trajectories[sensor]) pose.time_us += to_microseconds(offset);
  clocks.of_sensor[sensor].offset = offset;
  clocks.known[sensor] = true;
}

/// Finds the offset of a sensor by its motion, on the clock of a sensor that is known. False: it cannot be
/// found from that one.
bool find(std::size_t known, std::size_t sensor, double max_gap, std::vector<Trajectory>& trajectories,
          Clocks& clocks) {
  CalibrationOptions options;
  options.pairing.max_gap = max_gap;
  std::vector<ClockOfDrive> of_drives = put_drives_on_clock_of_a(
      clocks.drives, known, sensor, trajectories[known], trajectories[sensor], options);
  if (!of_drives.empty()) {
    clocks.not_found[sensor] = false;
    clocks.known[sensor] = true;
    clocks.of_sensor[sensor] = {of_drives.front().estimate.seconds, 0, of_drives,
                                clocks.of_sensor[known].group};
    return true;
  }
  const auto offset = estimate_time_offset(trajectories[known], trajectories[sensor], {.max_gap = max_gap});
  clocks.not_found[sensor] = !offset;
  if (!offset) return false;
  clocks.of_sensor[sensor].group = clocks.of_sensor[known].group;
  trajectories[sensor] = on_clock_of_a(*offset, std::move(trajectories[sensor]));
  clocks.of_sensor[sensor].offset = offset->seconds;
  if (offset->rival) clocks.of_sensor[sensor].period = std::abs(*offset->rival - offset->seconds);
  clocks.known[sensor] = true;
  return true;
}

/// Puts one more sensor on the common clock, along a pair whose offset is a number. False where there is no
/// such pair of a known and an unknown sensor.
bool put_by_numbers(const RigSettings& settings, std::vector<Trajectory>& trajectories, Clocks& clocks) {
  for (const RigPairSettings& pair : settings.pairs) {
    if (!pair.listed || !pair.time_offset || clocks.known[pair.a] == clocks.known[pair.b]) continue;
    const auto [known, other] = clocks.known[pair.a] ? std::pair{pair.a, pair.b} : std::pair{pair.b, pair.a};
    clocks.of_sensor[other].group = clocks.of_sensor[known].group;
    if (clocks.known[pair.a])
      put(pair.b, clocks.of_sensor[pair.a].offset + *pair.time_offset, trajectories, clocks);
    else
      put(pair.a, clocks.of_sensor[pair.b].offset - *pair.time_offset, trajectories, clocks);
    return true;
  }
  return false;
}

/// The same along a pair whose offset is found by the motion.
bool put_by_motion(const RigSettings& settings, std::vector<Trajectory>& trajectories, Clocks& clocks) {
  for (const RigPairSettings& pair : settings.pairs) {
    if (!pair.listed || pair.time_offset || clocks.known[pair.a] == clocks.known[pair.b]) continue;
    const auto [known, other] = clocks.known[pair.a] ? std::pair{pair.a, pair.b} : std::pair{pair.b, pair.a};
    if (find(known, other, pair.calibration.pairing.max_gap, trajectories, clocks)) return true;
  }
  return false;
}

void require_one_clock_each(const RigRequest& request, const RigSettings& settings, const Clocks& clocks) {
  for (const RigPairSettings& pair : settings.pairs) {
    if (!pair.listed || !pair.time_offset) continue;
    const double others = clocks.of_sensor[pair.b].offset - clocks.of_sensor[pair.a].offset;
    if (std::abs(others - *pair.time_offset) > least_contradiction)
      throw Error(fmt::format(
          "{}: pair of \"{}\" and \"{}\": time_offset: {:+.4f} s, but {:+.4f} s by the other pairs (0 where "
          "none is given): a sensor of a rig has one clock; give the same here, or \"auto\"",
          request.rig, settings.names[pair.a], settings.names[pair.b], *pair.time_offset, others));
  }
}

}  // namespace

std::vector<ClockOfSensor> synchronise(const RigRequest& request, const RigSettings& settings,
                                       const Drives& drives, std::vector<Trajectory>& trajectories) {
  Clocks clocks{drives, std::vector<ClockOfSensor>(trajectories.size()),
                std::vector<bool>(trajectories.size(), false), std::vector<bool>(trajectories.size(), false)};
  clocks.known.front() = true;
  if (request.calibration.estimate_time_offset) {
    // the first that is known may have no time in common with this one
    for (std::size_t left = 1; left < trajectories.size(); ++left) {
      bool found = false;
      std::size_t first = 0;
      for (std::size_t k = 1; k < trajectories.size() && !found; ++k) {
        if (clocks.known[k]) continue;
        if (first == 0) first = k;
        for (std::size_t known = 0; known < trajectories.size() && !found; ++known)
          found = clocks.known[known] &&
                  find(known, k, settings.pairs.front().calibration.pairing.max_gap, trajectories, clocks);
      }
      if (!found) clocks.begin_group(first);
    }
    return clocks.of_sensor;
  }
  while (std::find(clocks.known.begin(), clocks.known.end(), false) != clocks.known.end()) {
    if (put_by_numbers(settings, trajectories, clocks) || put_by_motion(settings, trajectories, clocks))
      continue;
    const auto unknown = std::find(clocks.known.begin(), clocks.known.end(), false);
    const auto sensor = static_cast<std::size_t>(unknown - clocks.known.begin());
    if (clocks.not_found[sensor])
      clocks.begin_group(sensor);
    else
      clocks.known[sensor] = true;  // of no pair with these
  }
  require_one_clock_each(request, settings, clocks);
  return clocks.of_sensor;
}

}  // namespace egocal::tools
