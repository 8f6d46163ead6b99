// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/source.hpp"

#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"
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

DataSet recorded(const Source& source) {
  const Trajectory a = read_trajectory(source.file_a, source.times_a);
  const Trajectory b = read_trajectory(source.file_b, source.times_b);
  PairingOptions options;
  options.stride = source.stride;
  options.balance = Balance{};
  options.time_offset = source.time_offset;
  DataSet data;
  data.pairs = pair_motions(options, a, b).pairs;
  if (data.pairs.empty())
    throw Error(source.file_a + ", " + source.file_b +
                ": no motion pairs: the two do not overlap in time, or every one was rejected");
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
