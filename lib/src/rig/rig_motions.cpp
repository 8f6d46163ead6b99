// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/rig/rig.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "egocal/microseconds.hpp"
#include "egocal/pairing/congruence.hpp"
#include "egocal/statistics/median.hpp"
#include "pairing/smooth_interpolation.hpp"

namespace egocal {

namespace {

/// Poses of all sensors at one time.
struct Instant {
  std::int64_t time_us = 0;
  std::vector<DualQuaternion> poses;
};

/// The sensor whose poses are furthest apart.
std::size_t slowest(std::span<const Trajectory> sensors) {
  std::size_t found = 0;
  double longest = -1;
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    if (sensors[k].size() < 2) return k;
    const double period = static_cast<double>(sensors[k].back().time_us - sensors[k].front().time_us) /
                          static_cast<double>(sensors[k].size() - 1);
    if (period > longest) longest = period, found = k;
  }
  return found;
}

/// The pose at a time, interpolated as pairing does (pairing/synchroniser.hpp); empty outside of the
/// trajectory and within a gap.
std::optional<DualQuaternion> pose_at(const Trajectory& trajectory, std::int64_t time_us, double max_gap) {
  const auto next =
      std::lower_bound(trajectory.begin(), trajectory.end(), time_us,
                       [](const StampedPose& pose, std::int64_t time) { return pose.time_us < time; });
  if (next == trajectory.end()) return std::nullopt;
  if (next->time_us == time_us) return next->pose;
  if (next == trajectory.begin()) return std::nullopt;
  const auto last = std::prev(next);
  const auto gap = static_cast<double>(next->time_us - last->time_us);
  if (gap > second_us * max_gap) return std::nullopt;
  const double part = static_cast<double>(time_us - last->time_us) / gap;
  const SynchroniserOptions options;
  const auto side = static_cast<std::ptrdiff_t>(options.smooth_poses / 2);
  if (next - trajectory.begin() >= side && trajectory.end() - next >= side)
    if (const auto smooth = detail::interpolate_smoothly({next - side, next + side}, part, options))
      return smooth;
  return interpolate(last->pose, next->pose, part);
}

std::vector<Instant> instants_of(std::span<const Trajectory> sensors, double max_gap) {
  std::vector<Instant> instants;
  for (const StampedPose& reference : sensors[slowest(sensors)]) {
    Instant instant{reference.time_us, {}};
    for (const Trajectory& sensor : sensors)
      if (const auto pose = pose_at(sensor, reference.time_us, max_gap)) instant.poses.push_back(*pose);
    if (instant.poses.size() == sensors.size()) instants.push_back(std::move(instant));
  }
  return instants;
}

/// For each instant, the number of gaps before it: a motion across one is not measured. A sensor that is slow
/// all through the drive has no gaps.
std::vector<int> gaps_before(const std::vector<Instant>& instants, double max_gap) {
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < instants.size(); ++i)
    periods.push_back(instants[i].time_us - instants[i - 1].time_us);
  if (periods.empty()) return std::vector<int>(instants.size(), 0);
  const double limit = std::max(second_us * max_gap, 1.5 * static_cast<double>(detail::median(periods)));
  std::vector<int> gaps = {0};
  for (const std::int64_t period : periods)
    gaps.push_back(gaps.back() + (static_cast<double>(period) > limit ? 1 : 0));
  return gaps;
}

DualQuaternion motion(const Instant& begin, const Instant& end, std::size_t sensor) {
  return canonical_sign(normalized(conjugate(begin.poses[sensor]) * end.poses[sensor]));
}

void see_from_planes(RigPair& pair, const std::vector<GroundPlane>& planes) {
  pair.problem.mode = Mode::planar;
  pair.problem.plane_a = planes[pair.a];
  pair.problem.plane_b = planes[pair.b];
  const DualQuaternion G_a = plane_frame(pair.problem.plane_a), G_b = plane_frame(pair.problem.plane_b);
  for (MotionPair& motion : pair.pairs) {
    motion.a = planar_motion(motion.a, G_a);
    motion.b = planar_motion(motion.b, G_b);
  }
}

}  // namespace

std::vector<RigPair> rig_motions(std::span<const Trajectory> sensors, const RigMotionsOptions& options) {
  std::vector<RigPair> pairs;
  if (sensors.size() < 2) return pairs;
  const std::vector<Instant> instants = instants_of(sensors, options.max_gap);
  const auto stride = static_cast<std::size_t>(std::max(1, options.stride));
  const std::size_t count = instants.size() > stride ? instants.size() - stride : 0;
  const std::vector<int> gaps = gaps_before(instants, options.max_gap);
  std::vector<bool> wrong(count, false);
  for (std::size_t i = 0; i < count; ++i) wrong[i] = gaps[i] != gaps[i + stride];
  for (std::size_t a = 0; a < sensors.size(); ++a)
    for (std::size_t b = a + 1; b < sensors.size(); ++b) {
      RigPair pair{a, b, {}, {}, {}};
      pair.problem.balance = options.balance;
      for (std::size_t i = 0; i < count; ++i)
        pair.pairs.push_back({motion(instants[i], instants[i + stride], a),
                              motion(instants[i], instants[i + stride], b), instants[i].time_us,
                              instants[i + stride].time_us, 1});
      const std::vector<bool> incongruent_here = incongruent(pair.pairs, options.screening);
      for (std::size_t i = 0; i < count; ++i) wrong[i] = wrong[i] || incongruent_here[i];
      pairs.push_back(std::move(pair));
    }
  for (RigPair& pair : pairs) {
    std::size_t i = 0;
    std::erase_if(pair.pairs, [&](const MotionPair&) { return wrong[i++]; });
    if (options.planes.size() == sensors.size()) see_from_planes(pair, options.planes);
  }
  return pairs;
}

}  // namespace egocal
