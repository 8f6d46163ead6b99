// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/sensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "egocal/error.hpp"
#include "egocal/microseconds.hpp"

namespace egocal {

namespace {

using detail::Path;

constexpr std::int64_t epoch_us =
    1'700'000'000'000'000;  // a plausible date: times of zero are refused on the wire

SensorFaults faults_of(const SimulationOptions& options, std::size_t sensor) {
  return sensor < options.faults.size() ? options.faults[sensor] : SensorFaults{};
}

/// The part of a mount change that has happened by a time.
Pose happened(const MountChange& change, double time) {
  if (time < change.begin) return {};
  if (!(change.end > change.begin) || time >= change.end) return change.change;
  const double part = (time - change.begin) / (change.end - change.begin);
  return {rotation_exp(part * rotation_log(change.change.rotation)), part * change.change.translation};
}

Pose mounting_at(const SimulationOptions& options, std::size_t sensor, double time) {
  Pose mounting = options.T_vehicle_sensor.at(sensor);
  for (const MountChange& change : faults_of(options, sensor).mount_changes)
    mounting = mounting * happened(change, time);
  return mounting;
}

/// A value between the second and the third of four at equal distances: by a cubic, whose slope at both is
/// that between their neighbours, so that the path has no corner at a pose.
Eigen::Vector3d between(const std::array<Eigen::Vector3d, 4>& values, double part) {
  const Eigen::Vector3d chord = values[2] - values[1];
  const Eigen::Vector3d begin = 0.5 * (values[2] - values[0]), end = 0.5 * (values[3] - values[1]);
  const double rest = 1 - part;
  return values[1] + part * chord + part * rest * (rest * (begin - chord) - part * (end - chord));
}

/// The pose between poses `next` - 1 and `next`; beyond the ends the path is straight.
Pose pose_between(const Path& path, std::size_t next, double part) {
  const auto pose = [&](std::size_t i) -> const Pose& { return path.poses[i]; };
  const Pose& from = pose(next - 1);
  const auto turn_to = [&](const Pose& to) { return rotation_log(from.rotation.conjugate() * to.rotation); };
  const bool first = next == 1, last = next + 1 == path.poses.size();
  const Eigen::Vector3d shift = pose(next).translation - from.translation, turn = turn_to(pose(next));
  std::array<Eigen::Vector3d, 4> positions{-shift, Eigen::Vector3d::Zero(), shift, 2 * shift},
      turns{-turn, Eigen::Vector3d::Zero(), turn, 2 * turn};
  if (!first) {
    positions[0] = pose(next - 2).translation - from.translation;
    turns[0] = turn_to(pose(next - 2));
  }
  if (!last) {
    positions[3] = pose(next + 1).translation - from.translation;
    turns[3] = turn_to(pose(next + 1));
  }
  return {(from.rotation * rotation_exp(between(turns, part))).normalized(),
          from.translation + between(positions, part)};
}

/// The same path at other times.
Path resampled(const Path& path, double rate, double phase) {
  Path result;
  std::size_t next = 1;
  for (std::int64_t i = 0;; ++i) {
    const double time = phase + static_cast<double>(i) / rate;
    if (time > path.times.back()) return result;
    while (next + 1 < path.times.size() && path.times[next] < time) ++next;
    const double part = (time - path.times[next - 1]) / (path.times[next] - path.times[next - 1]);
    result.stamps.push_back(to_microseconds(time));
    result.times.push_back(time);
    result.poses.push_back(pose_between(path, next, part));
  }
}

/// Student's distribution with three degrees of freedom, variance one, as a factor of normal numbers.
double tail_factor(Random& random) {
  const double chi2 = random.normal3().squaredNorm();
  return 1 / std::sqrt(chi2);
}

}  // namespace

Trajectory detail::drive_sensor(const SimulationOptions& options, const Path& drive, std::size_t sensor,
                                Random& random) {
  const SensorFaults faults = faults_of(options, sensor);
  const bool as_the_drive = faults.rate == 0 && faults.phase == 0;
  const Path path =
      as_the_drive ? drive : resampled(drive, faults.rate > 0 ? faults.rate : options.rate, faults.phase);
  Random chance(options.seed ^ (0x9e3779b97f4a7c15ULL * (sensor + 1)));
  // noise comes from the drive's numbers, as many as a sensor without faults takes
  Random noise = as_the_drive ? random : Random(options.seed ^ (0xbf58476d1ce4e5b9ULL * (sensor + 1)));
  for (std::size_t i = 1; i < drive.poses.size(); ++i) random.normal3(), random.normal3();

  std::vector<DualQuaternion> mountings, motions;
  for (const double time : path.times)
    mountings.push_back(to_dual_quaternion(mounting_at(options, sensor, time)));
  std::vector<double> turns, ways;
  double rotation = 0, translation = 0;
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    const DualQuaternion motion = to_dual_quaternion(inverse(path.poses[i - 1]) * path.poses[i]);
    motions.push_back(canonical_sign(normalized(conjugate(mountings[i - 1]) * motion * mountings[i])));
    const Pose seen = to_pose(motions.back());
    turns.push_back(rotation_log(seen.rotation).norm());
    ways.push_back(seen.translation.norm());
    rotation += turns.back();
    translation += ways.back();
  }
  const double count = static_cast<double>(std::max<std::size_t>(1, motions.size()));
  const double of_all_r = options.noise_rotation + options.relative_noise * rotation / count;
  const double of_all_t = options.noise_translation + options.relative_noise * translation / count;

  constexpr double correlation = 0.9;  // of wandering noise from pose to pose: ten poses
  Trajectory trajectory;
  DualQuaternion pose;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();
  std::size_t next_jump = 0;
  std::vector<OdometryJump> jumps = faults.jumps;
  std::stable_sort(jumps.begin(), jumps.end(),
                   [](const OdometryJump& i, const OdometryJump& k) { return i.time < k.time; });
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    if (i > 0) {
      const double sigma_r = faults.noise_factor * (of_all_r + options.noise_of_motion * turns[i - 1]);
      const double sigma_t = faults.noise_factor * (of_all_t + options.noise_of_motion * ways[i - 1]);
      const double keep = options.random_walk && i > 1 ? correlation : 0;
      const double tail_r = options.heavy_tails ? tail_factor(chance) : 1;
      const double tail_t = options.heavy_tails ? tail_factor(chance) : 1;
      turn = keep * turn + std::sqrt(1 - keep * keep) * sigma_r * tail_r * noise.normal3();
      shift = keep * shift + std::sqrt(1 - keep * keep) * sigma_t * tail_t * noise.normal3();
      DualQuaternion motion = motions[i - 1];
      if (sigma_r > 0 || sigma_t > 0) motion = motion * to_dual_quaternion({rotation_exp(turn), shift});
      if (faults.scale != 1 || faults.scale_drift != 0)
        motion.dual /= faults.scale * std::exp(faults.scale_drift * path.times[i]);
      for (; next_jump < jumps.size() && jumps[next_jump].time <= path.times[i]; ++next_jump)
        motion = motion * to_dual_quaternion(jumps[next_jump].jump);
      pose = canonical_sign(normalized(pose * motion));
    }
    const bool dropped = faults.dropped > 0 && chance.uniform() < faults.dropped;
    const bool wrong = faults.outliers > 0 && chance.uniform() < faults.outliers;
    DualQuaternion said = pose;
    if (wrong)
      said = normalized(said *
                        to_dual_quaternion({rotation_exp(faults.outlier_rotation * chance.normal3()),
                                            faults.outlier_translation / faults.scale * chance.normal3()}));
    const double clock = faults.clock_offset + faults.clock_drift * path.times[i];
    if (!dropped) trajectory.push_back({epoch_us + path.stamps[i] + to_microseconds(clock), said});
  }
  return trajectory;
}

Pose true_extrinsic(const SimulationOptions& options, std::size_t a, std::size_t b, double time) {
  const std::size_t sensors = options.T_vehicle_sensor.size();
  if (std::max(a, b) >= sensors)
    throw Error("sensor " + std::to_string(std::max(a, b)) + ": the simulation has " +
                std::to_string(sensors));
  return inverse(mounting_at(options, a, time)) * mounting_at(options, b, time);
}

}  // namespace egocal
