// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/simulated_faults.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "arguments.hpp"
#include "egocal/degrees.hpp"

namespace egocal::tools {

namespace {

/// Splits at every `separator`.
std::vector<std::string> parts(const std::string& text, char separator) {
  std::vector<std::string> result;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = text.find(separator, begin);
    result.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return result;
    begin = end + 1;
  }
}

/// Hands the value of each NAME=VALUE to `take`, with the faults of that sensor.
template <typename Take>
void for_each(const char* option, const std::vector<std::string>& texts,
              const std::vector<std::string>& names, std::vector<SensorFaults>& faults, const Take& take) {
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const auto name = std::find(names.begin(), names.end(), text.substr(0, equals));
    if (equals == std::string::npos || name == names.end())
      throw UsageError(std::string(option) + ": expected NAME=VALUE with the name of a --sensor, got '" +
                       text + "'");
    take(faults[static_cast<std::size_t>(name - names.begin())], text.substr(equals + 1));
  }
}

/// DX,DY,DZ,ROLL,PITCH,YAW in metres and degrees.
Pose change(const char* option, const std::string& text) {
  const std::vector<std::string> numbers = parts(text, ',');
  if (numbers.size() != 6)
    throw UsageError(std::string(option) + ": expected DX,DY,DZ,ROLL,PITCH,YAW [m, deg], got '" + text + "'");
  constexpr Range metres{-1e3, 1e3}, degrees{-360, 360};  // limits of a mount
  double value[6];
  for (std::size_t i = 0; i < 6; ++i) value[i] = number_in(option, numbers[i], i < 3 ? metres : degrees);
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Quaterniond rotation = AngleAxisd(radians_per_degree * value[5], Vector3d::UnitZ()) *
                                      AngleAxisd(radians_per_degree * value[4], Vector3d::UnitY()) *
                                      AngleAxisd(radians_per_degree * value[3], Vector3d::UnitX());
  return {rotation, {value[0], value[1], value[2]}};
}

/// The parts of TIME:...:CHANGE.
std::vector<std::string> timed(const char* option, const std::string& text, std::size_t count,
                               const char* expected) {
  std::vector<std::string> result = parts(text, ':');
  if (result.size() != count)
    throw UsageError(std::string(option) + ": expected NAME=" + expected + ", got '" + text + "'");
  return result;
}

/// A time within the drive [s].
double time_in(const char* option, const std::string& text, const Range& drive) {
  const double time = number(option, text);
  if (!drive.contains(time))
    throw UsageError(
        fmt::format("{}: expected a time within the drive, 0 to {:g} s, got '{}'", option, drive.most, text));
  return time;
}

}  // namespace

void add_fault_options(cli::App command, FaultTexts& texts) {
  const auto add = [&](const char* option, std::vector<std::string>& values, const char* help) {
    command.add_option(option, values, std::string("fault: ") + help).each_a_value();
  };
  add("--sensor-rate", texts.rates, "NAME=HZ: its own rate");
  add("--phase", texts.phases, "NAME=S: time of its first pose");
  add("--scale", texts.scales, "NAME=S: its lengths are S times too short");
  add("--scale-drift", texts.scale_drifts, "NAME=R: its scale grows by the part R every second");
  add("--clock-offset", texts.clock_offsets, "NAME=S: added to its stamps [s]");
  add("--clock-drift", texts.clock_drifts, "NAME=R: its stamps gain R every second [s/s]");
  add("--drop", texts.dropped, "NAME=SHARE of its poses that are missing");
  add("--outliers", texts.outliers, "NAME=SHARE of its poses that are wrong");
  add("--noise-factor", texts.noise_factors, "NAME=F: its noise is F times the drive's");
  add("--bump", texts.bumps, "NAME=TIME:DX,DY,DZ,ROLL,PITCH,YAW: its mount moves at a time [s, m, deg]");
  add("--creep", texts.creeps, "NAME=BEGIN:END:DX,DY,DZ,ROLL,PITCH,YAW: its mount moves slowly");
  add("--jump", texts.jumps, "NAME=TIME:DX,DY,DZ,ROLL,PITCH,YAW: its odometry jumps, the mount stays");
}

std::vector<SensorFaults> understood(const FaultTexts& texts, const std::vector<std::string>& names,
                                     double duration) {
  std::vector<SensorFaults> faults(names.size());
  const auto set = [&](const char* option, const std::vector<std::string>& values,
                       double SensorFaults::*field, const Range& range) {
    std::vector<const SensorFaults*> given;
    for_each(option, values, names, faults, [&](SensorFaults& sensor, const std::string& text) {
      if (std::find(given.begin(), given.end(), &sensor) != given.end())
        throw UsageError(std::string(option) + ": is given twice for one sensor, the second time as '" +
                         text + "'");
      given.push_back(&sensor);
      sensor.*field = number_in(option, text, range);
    });
  };
  namespace in = limits::simulation;
  set("--sensor-rate", texts.rates, &SensorFaults::rate, in::rate);
  set("--phase", texts.phases, &SensorFaults::phase, {0, duration});
  set("--scale", texts.scales, &SensorFaults::scale, in::scale);
  set("--scale-drift", texts.scale_drifts, &SensorFaults::scale_drift, in::scale_drift);
  set("--clock-offset", texts.clock_offsets, &SensorFaults::clock_offset, in::clock_offset);
  set("--clock-drift", texts.clock_drifts, &SensorFaults::clock_drift, in::clock_drift);
  set("--drop", texts.dropped, &SensorFaults::dropped, in::dropped);
  set("--outliers", texts.outliers, &SensorFaults::outliers, in::outliers);
  set("--noise-factor", texts.noise_factors, &SensorFaults::noise_factor, in::noise_factor);
  const Range within{0, duration};
  for_each("--bump", texts.bumps, names, faults, [&](SensorFaults& sensor, const std::string& text) {
    const auto part = timed("--bump", text, 2, "TIME:DX,DY,DZ,ROLL,PITCH,YAW");
    const double time = time_in("--bump", part[0], within);
    sensor.mount_changes.push_back({time, time, change("--bump", part[1])});
  });
  for_each("--creep", texts.creeps, names, faults, [&](SensorFaults& sensor, const std::string& text) {
    const auto part = timed("--creep", text, 3, "BEGIN:END:DX,DY,DZ,ROLL,PITCH,YAW");
    const double begin = time_in("--creep", part[0], within);
    // it may still be on its way at the end
    const double end = number_in("--creep", part[1], {begin, 1e9});
    sensor.mount_changes.push_back({begin, end, change("--creep", part[2])});
  });
  for_each("--jump", texts.jumps, names, faults, [&](SensorFaults& sensor, const std::string& text) {
    const auto part = timed("--jump", text, 2, "TIME:DX,DY,DZ,ROLL,PITCH,YAW");
    sensor.jumps.push_back({time_in("--jump", part[0], within), change("--jump", part[1])});
  });
  return faults;
}

}  // namespace egocal::tools
