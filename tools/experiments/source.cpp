// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/source.hpp"

#include <filesystem>
#include <sstream>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::tools {

namespace {

DataSet simulated(const Source& source) {
  SimulationOptions options;
  options.terrain = source.terrain;
  const Pose T{rotation_exp({0.3, -0.2, 2.0}), {2.5, -1.2, 0.6}};
  options.poses = source.poses;
  options.relative_noise = source.noise;
  options.seed = source.seed;
  options.T_vehicle_sensor = {Pose{}, T};
  const std::vector<Trajectory> trajectories = simulate(options);
  DataSet data;
  data.pairs = motions(trajectories[0], trajectories[1]);
  data.truth = to_dual_quaternion(T);
  return data;
}

/// "A1,A2" in its parts; a comma that belongs to the name of an existing file stays there.
std::vector<std::string> drives_in(const std::string& text) {
  if (text.find(',') == std::string::npos || std::filesystem::exists(text)) return {text};
  std::vector<std::string> names;
  std::istringstream stream(text);
  for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
  return names;
}

std::vector<MotionPair> pairs_of_drive(const Source& source, std::vector<std::string>& notes) {
  const auto read = [&](const std::string& name, const ReadOptions& options) {
    TrajectoryReading reading = source.read(name, options);
    for (const std::string& note : reading.notes) notes.push_back(name + ": " + note);
    return std::move(reading.trajectory);
  };
  const Trajectory a = read(source.file_a, source.reading_a);
  const Trajectory b = read(source.file_b, source.reading_b);
  PairingOptions options;
  options.stride = source.stride;
  options.balance = Balance{};
  options.time_offset = source.time_offset;
  std::vector<MotionPair> pairs = pair_motions(options, a, b).pairs;
  if (pairs.empty())
    throw Error(source.file_a + ", " + source.file_b +
                ": no motion pairs: the two do not overlap in time, or every one was rejected");
  return pairs;
}

/// The drives one after the other: statistics add up (Table II).
DataSet recorded(const Source& source) {
  const std::vector<std::string> a = drives_in(source.file_a), b = drives_in(source.file_b);
  if (a.size() != b.size())
    throw Error("expected as many drives of A as of B, got " + std::to_string(a.size()) + " and " +
                std::to_string(b.size()));
  DataSet data;
  for (std::size_t i = 0; i < a.size(); ++i) {
    Source drive = source;
    drive.file_a = a[i];
    drive.file_b = b[i];
    const std::vector<MotionPair> pairs = pairs_of_drive(drive, data.notes);
    data.pairs.insert(data.pairs.end(), pairs.begin(), pairs.end());
  }
  return data;
}

}  // namespace

DataSet load(const Source& source) {
  DataSet data = source.file_a.empty() ? simulated(source) : recorded(source);
  if (source.truth) data.truth = to_dual_quaternion(*source.truth);
  data.plane_a = source.plane_a;
  data.plane_b = source.plane_b;
  data.balance = source.balance;
  return data;
}

}  // namespace egocal::tools
