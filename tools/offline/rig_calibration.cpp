// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "arguments.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/rig/rig.hpp"
#include "offline/append.hpp"
#include "offline/log_trajectory.hpp"
#include "offline/rig_findings.hpp"
#include "offline/trajectory_source.hpp"

namespace egocal::tools {

namespace {

/// Names and sources of the sensors of the rig that have one, and the planes of a planar rig.
void take_from_rig(RigRequest& request, std::vector<GroundPlane>& planes) {
  const bus::Rig rig = bus::read_rig(request.rig);
  for (const bus::Sensor& sensor : rig.sensors)
    if (sensor.find_scale)
      throw Error("--rig: sensor \"" + sensor.name +
                  "\" has scale = \"auto\": find it with solve A B --scale auto, and put the number there");
  if (request.from.empty() == request.log.empty())
    throw UsageError("--rig: expected --from NAME=FILE for its sensors, or --log FILE");
  const auto take = [&](const bus::Sensor& sensor, const std::string& source) {
    request.names.push_back(sensor.name);
    request.sources.push_back(source);
    if (sensor.plane) planes.push_back(*sensor.plane);
  };
  for (const std::string& text : request.from) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      throw UsageError("--from: expected NAME=FILE, got '" + text + "'");
    const std::string name = text.substr(0, equals);
    if (std::find(request.names.begin(), request.names.end(), name) != request.names.end())
      throw UsageError("--from: the sensor " + name +
                       " is given twice; another drive of all sensors goes with --append");
    take(bus::sensor(rig, name), text.substr(equals + 1));
  }
  if (!request.log.empty())
    for (const bus::Sensor& sensor : rig.sensors) take(sensor, sensor.channel);
  const bool planar = !rig.pairs.empty() &&
                      std::all_of(rig.pairs.begin(), rig.pairs.end(),
                                  [](const bus::PairConfig& pair) { return pair.mode == Mode::planar; });
  if (!planar || planes.size() != request.names.size()) planes.clear();
  request.calibration.pairing.max_gap = rig.max_gap;
}

/// The sensors' first drive.
std::vector<Trajectory> read(const RigRequest& request, RigReport& report) {
  std::vector<Trajectory> trajectories;
  std::string damage;  // of the log, whichever channel is read
  for (const std::string& source : request.sources) {
    if (request.log.empty()) {
      trajectories.push_back(read_noting(source, request.reading, report.warnings));
      continue;
    }
    LogTrajectory channel = read_log_trajectory(request.log, source);
    if (!channel.not_used.empty()) report.warnings.push_back(channel.not_used);
    damage = std::move(channel.damage);
    trajectories.push_back(std::move(channel.poses));
  }
  if (!damage.empty()) report.warnings.push_back(damage);
  return trajectories;
}

/// Further drives, each after the ones before it.
Drives append_drives(const RigRequest& request, std::vector<Trajectory>& trajectories, RigReport& report) {
  if (request.append.size() % trajectories.size() != 0)
    throw UsageError("--append: expected one file for each sensor");
  std::vector<Trajectory*> sensors;
  sensors.reserve(trajectories.size());
  for (Trajectory& trajectory : trajectories) sensors.push_back(&trajectory);
  Drives drives(sensors, request.sources);
  for (std::size_t i = 0; i < request.append.size(); i += trajectories.size()) {
    const auto begin = request.append.begin() + static_cast<std::ptrdiff_t>(i);
    std::vector<std::string> names(begin, begin + static_cast<std::ptrdiff_t>(trajectories.size()));
    std::vector<Trajectory> drive;
    drive.reserve(names.size());
    for (const std::string& name : names)
      drive.push_back(read_noting(name, request.reading, report.warnings));
    drives.append(std::move(drive), std::move(names));
  }
  return drives;
}

/// What was added to the stamps of a sensor [s], and after what time its motion repeats, so that another
/// offset fits as well [s]; 0: none does.
struct ClockOfSensor {
  double offset = 0, period = 0;
};

/// All sensors on the clock of the first one.
std::vector<ClockOfSensor> synchronise(std::vector<Trajectory>& trajectories, const RigRequest& request) {
  std::vector<ClockOfSensor> clocks(trajectories.size());
  if (!request.calibration.estimate_time_offset) return clocks;
  for (std::size_t k = 1; k < trajectories.size(); ++k) {
    const auto offset = estimate_time_offset(trajectories[0], trajectories[k],
                                             {.max_gap = request.calibration.pairing.max_gap});
    if (!offset)
      throw Error(request.names[0] + ", " + request.names[k] +
                  ": time offset: cannot be estimated, the streams are too short or never turn");
    trajectories[k] = on_clock_of_a(*offset, std::move(trajectories[k]));
    clocks[k].offset = offset->seconds;
    if (offset->rival) clocks[k].period = std::abs(*offset->rival - offset->seconds);
  }
  return clocks;
}

/// Which of the offsets is right is open, and so is the answer.
void put_rival_offset(const ClockOfSensor& clock, const std::string& name, Calibration& calibration) {
  if (clock.period == 0) return;
  Finding finding;
  finding.code = "clock_offset";
  finding.message = rival_offsets_in_words(clock.period, name);
  finding.remedy = "Add some motion that does not repeat, or leave out --time-offset where the clocks agree.";
  if (calibration.verdict == Verdict::good) {
    calibration.verdict = Verdict::incomplete;
    calibration.reason = finding.message;
  }
  calibration.findings.push_back(std::move(finding));
}

PairingOptions pairing_of(const RigRequest& request, const std::vector<GroundPlane>& planes, std::size_t a,
                          std::size_t b) {
  PairingOptions pairing = request.calibration.pairing;
  pairing.time_offset = 0;
  if (planes.empty()) return pairing;
  pairing.mode = Mode::planar;
  pairing.plane_a = planes[a];
  pairing.plane_b = planes[b];
  return pairing;
}

/// Stride and balance for all pairs: the longest stride that a pair chooses, and the balance that goes with
/// it. What is common keeps the errors of the pairs dependent, and the loops closed.
Choice common_choice(const std::vector<Trajectory>& trajectories, const RigRequest& request,
                     const std::vector<GroundPlane>& planes) {
  Choice common;
  common.stride = 0;
  for (std::size_t a = 0; a < trajectories.size(); ++a)
    for (std::size_t b = a + 1; b < trajectories.size(); ++b) {
      const PairingOptions pairing = pairing_of(request, planes, a, b);
      const Choice choice = pair_motions(pairing, trajectories[a], trajectories[b]).drive.choice();
      if (choice.stride > common.stride) common = choice;
    }
  common.reason = "common to all pairs, by the one with the longest stride: " + common.reason;
  return common;
}

void calibrate_pairs(const std::vector<Trajectory>& trajectories, const RigRequest& request,
                     const std::vector<GroundPlane>& planes, const std::vector<ClockOfSensor>& clocks,
                     const Choice& common, RigReport& report) {
  for (std::size_t a = 0; a < trajectories.size(); ++a)
    for (std::size_t b = a + 1; b < trajectories.size(); ++b) {
      CalibrationOptions options = request.calibration;
      options.estimate_time_offset = false;
      options.pairing = pairing_of(request, planes, a, b);
      options.pairing.stride = common.stride;
      options.pairing.balance = common.balance;
      try {
        report.pairs.push_back(calibrate(trajectories[a], trajectories[b], options));
      } catch (const Error& error) {
        throw Error(request.names[a] + ", " + request.names[b] + ": " + error.what());
      }
      Calibration& calibration = report.pairs.back();
      calibration.choice.reason = common.reason;
      calibration.time_offset_applied = clocks[b].offset - clocks[a].offset;
      for (const std::size_t k : {a, b}) put_rival_offset(clocks[k], request.names[k], calibration);
      report.contradictory = report.contradictory || calibration.verdict == Verdict::contradictory;
    }
}

}  // namespace

RigReport calibrate_rig(const RigRequest& given) {
  RigRequest request = given;
  std::vector<GroundPlane> planes;
  if (!request.rig.empty()) take_from_rig(request, planes);
  if (request.sources.size() < 2) throw UsageError("solve: expected two sensors at least");
  RigReport report;
  report.names = request.names;
  report.sources = request.sources;
  std::vector<Trajectory> trajectories = read(request, report);
  const Drives drives = append_drives(request, trajectories, report);
  const std::vector<ClockOfSensor> clocks = synchronise(trajectories, request);
  const Choice common = common_choice(trajectories, request, planes);
  calibrate_pairs(trajectories, request, planes, clocks, common, report);
  for (std::size_t a = 0; a < trajectories.size(); ++a)
    for (std::size_t b = a + 1; b < trajectories.size(); ++b)
      drives.require_motions(a, b, trajectories[a], trajectories[b], pairing_of(request, planes, a, b));

  RigMotionsOptions options;
  options.stride = common.stride;
  options.balance = common.balance;
  options.max_gap = request.calibration.pairing.max_gap;
  options.planes = planes;
  options.screening = request.calibration.pairing.screening;
  std::vector<RigPair> pairs = rig_motions(trajectories, options);
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].T_a_b = to_dual_quaternion(report.pairs[i].T_a_b);
  if (!pairs.empty() && pairs.front().pairs.empty())
    throw Error("solve: there is no motion that all sensors were seen in: do the files overlap in time?");
  report.solution = solve_rig(trajectories.size(), pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    report.pairs[i].T_a_b = to_pose(report.solution.pairs[i].T_a_b);
  const double begin =
      to_seconds(pairs.front().pairs.front().begin_us - trajectories.front().front().time_us);
  options.stride = 1;
  find_in_rig(pairs, common.stride > 1 ? rig_motions(trajectories, options) : std::vector<RigPair>{}, begin,
              report);
  return report;
}

}  // namespace egocal::tools
