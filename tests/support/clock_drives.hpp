// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Two streams whose clocks differ, and what is wrong with streams beside that.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "random_motion.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// Free motion at 50 Hz; b thinned to 10 Hz, so that the stamps never help.
inline Streams simulated(double noise, std::uint64_t seed, int seconds = 120) {
  Streams streams = testing::simulated_drive({.terrain = Terrain::free,
                                              .poses = 50 * seconds,
                                              .rate = 50,
                                              .speed = 2,
                                              .relative_noise = noise,
                                              .seed = seed});
  Trajectory b;
  for (std::size_t i = 2; i < streams.b.size(); i += 5) b.push_back(streams.b[i]);
  streams.b = std::move(b);
  return streams;
}

inline Trajectory shifted(Trajectory path, double seconds) {
  for (StampedPose& pose : path) pose.time_us += std::llround(seconds * 1e6);
  return path;
}

inline Trajectory thinned(const Trajectory& path, double part, std::uint64_t seed) {
  testing::Random random(seed);
  Trajectory result;
  for (const StampedPose& pose : path)
    if (random.uniform() >= part) result.push_back(pose);
  return result;
}

/// Poses with a jump of 1 m and 0.1 rad each.
inline Trajectory glitched(Trajectory path, double part, std::uint64_t seed) {
  testing::Random random(seed);
  for (StampedPose& pose : path)
    if (random.uniform() < part)
      pose.pose = normalized(pose.pose * testing::random_displacement(random, 0.1, 1));
  return path;
}

/// Tracking that is lost this often, and found again up to 1 m and 0.2 rad elsewhere.
inline Trajectory jumping(Trajectory path, std::size_t jumps, std::uint64_t seed) {
  testing::Random random(seed);
  for (std::size_t k = 0; k < jumps; ++k) {
    const auto from = 20 + static_cast<std::size_t>(random.uniform() * static_cast<double>(path.size() - 40));
    const DualQuaternion start = path[from].pose;
    const DualQuaternion elsewhere =
        normalized(start * testing::random_displacement(random, 0.2, 1) * conjugate(start));
    for (std::size_t i = from; i < path.size(); ++i) path[i].pose = normalized(elsewhere * path[i].pose);
  }
  return path;
}

inline Trajectory drifting(Trajectory path, double rate) {
  const std::int64_t begin = path.front().time_us;
  for (StampedPose& pose : path)
    pose.time_us -= std::llround(rate * static_cast<double>(pose.time_us - begin));
  return path;
}

}  // namespace egocal::testing
