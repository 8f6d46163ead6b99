// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/source.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/pairing/drive.hpp"
#include "egocal/simulation/simulation.hpp"

namespace egocal::tools {

namespace {

/// Numbers separated by commas (or by `separator`).
std::vector<double> numbers(const std::string& text, const std::string& option, std::size_t count,
                            char separator = ',') {
  std::vector<double> values;
  const char* at = text.c_str();
  while (true) {
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end == at || !std::isfinite(value)) break;
    values.push_back(value);
    at = end;
    if (*at != separator) break;
    ++at;
  }
  if (values.size() != count || *at != '\0')
    throw Error(
        fmt::format("{}: expected {} numbers separated by '{}', got '{}'", option, count, separator, text));
  return values;
}

std::optional<GroundPlane> plane(const std::string& text, const std::string& option) {
  if (text.empty()) return std::nullopt;
  const std::vector<double> v = numbers(text, option, 4);
  return checked({{v[0], v[1], v[2]}, v[3]});
}

DataSet simulated(const Source& source) {
  SimulationOptions options;
  if (source.terrain == "flat") {
    options.terrain = Terrain::flat;
  } else if (source.terrain == "rough") {
    options.terrain = Terrain::rough;
  } else if (source.terrain == "free") {
    options.terrain = Terrain::free;
  } else {
    throw Error("--terrain: expected flat, rough or free, got '" + source.terrain + "'");
  }
  if (source.poses < 3) throw Error("--poses: expected at least 3");
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

DataSet recorded(const Source& source) {
  const Trajectory a = read_trajectory(source.file_a, source.times_a);
  const Trajectory b = read_trajectory(source.file_b, source.times_b);
  if (source.stride < 1) throw Error("--stride: expected 1 or more");
  DriveOptions options;
  options.stride = source.stride;
  options.balance = Balance{};
  options.time_offset = source.time_offset;
  Drive drive(options);
  DataSet data;
  const auto push = [&](Side side, const StampedPose& pose) {
    for (const MotionPair& pair : drive.push(side, pose)) data.pairs.push_back(pair);
  };
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const bool first = j == b.size() || (i < a.size() && a[i].time_us <= b[j].time_us);
    if (first) {
      push(Side::a, a[i++]);
    } else {
      push(Side::b, b[j++]);
    }
  }
  if (data.pairs.empty())
    throw Error(source.file_a + ", " + source.file_b +
                ": no motion pairs: the two do not overlap in time, or every one was rejected");
  return data;
}

}  // namespace

DataSet load(const Source& source) {
  if (source.file_a.empty() != source.file_b.empty()) throw Error("expected two trajectory files, or none");
  DataSet data = source.file_a.empty() ? simulated(source) : recorded(source);
  if (!source.truth.empty()) {
    const std::vector<double> v = numbers(source.truth, "--truth", 7);
    const Eigen::Quaterniond rotation(v[3], v[4], v[5], v[6]);
    if (!(rotation.norm() > 0.9 && rotation.norm() < 1.1))
      throw Error("--truth: expected a unit quaternion QW,QX,QY,QZ");
    data.truth = to_dual_quaternion({rotation.normalized(), {v[0], v[1], v[2]}});
  }
  data.plane_a = plane(source.plane_a, "--plane-a");
  data.plane_b = plane(source.plane_b, "--plane-b");
  if (data.plane_a.has_value() != data.plane_b.has_value())
    throw Error("--plane-a and --plane-b: expected both or none");
  if (source.weights != "equal") {
    const std::vector<double> v = numbers(source.weights, "--weights", 2, ':');
    if (!(v[0] >= 0 && v[1] > 0)) throw Error("--weights: expected R:T with R >= 0 and T > 0");
    data.balance = {v[0], v[1]};
  }
  return data;
}

}  // namespace egocal::tools
