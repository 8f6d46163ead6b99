// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "random_motion.hpp"

namespace egocal::testing {

/// The trajectory with a stop of `periods` periods after pose `at`. During the stop the positions jitter by
/// `jitter` [m], the rotations by a tenth of that [rad].
inline Trajectory with_stand(const Trajectory& trajectory, std::size_t at, std::int64_t periods,
                             std::int64_t spacing_us, double jitter, Random& random) {
  const auto there = trajectory.begin() + static_cast<std::ptrdiff_t>(at) + 1;
  Trajectory result(trajectory.begin(), there);
  const StampedPose stands = result.back();
  for (std::int64_t i = 1; i <= periods; ++i) {
    const DualQuaternion moved =
        jitter > 0 ? stands.pose * displacement(random.normal3(0.1 * jitter), random.normal3(jitter))
                   : stands.pose;
    result.push_back({stands.time_us + i * spacing_us, moved});
  }
  for (auto pose = there; pose != trajectory.end(); ++pose)
    result.push_back({pose->time_us + periods * spacing_us, pose->pose});
  return result;
}

}  // namespace egocal::testing
