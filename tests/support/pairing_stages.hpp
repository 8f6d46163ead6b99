// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What goes into a stage of the pairing and comes out of it.
#pragma once

#include <cstdint>
#include <vector>

#include "egocal/pairing/motion_pairing.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

/// A drive in free motion.
inline Streams simulated(int poses, double noise = 0.01, std::uint64_t seed = 1) {
  return simulated_drive({.terrain = Terrain::free, .poses = poses, .relative_noise = noise, .seed = seed});
}

inline std::uint64_t rejected(const Rejections& rejections, Rejection reason) {
  return rejections.by_reason[static_cast<std::size_t>(reason)];
}

/// What the synchroniser makes of streams whose poses have the same stamps.
inline std::vector<Instant> instants_of(const Streams& data) {
  std::vector<Instant> instants;
  for (std::size_t i = 0; i < data.a.size(); ++i)
    instants.push_back({data.a[i].time_us, data.a[i].pose, data.b[i].pose, 0, i + 1});
  return instants;
}

/// Between two poses of a simulated drive.
inline constexpr std::int64_t period_us = 100'000;

}  // namespace egocal::testing
