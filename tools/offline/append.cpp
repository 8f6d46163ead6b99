// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/append.hpp"

#include <algorithm>
#include <limits>

namespace egocal::tools {

void append_drive(const std::vector<Trajectory*>& sensors, std::vector<Trajectory> drive) {
  constexpr std::int64_t gap_us = 3'600'000'000;  // [us] an hour: no motion spans it
  std::int64_t end = std::numeric_limits<std::int64_t>::min(),
               begin = std::numeric_limits<std::int64_t>::max();
  for (const Trajectory* sensor : sensors)
    if (!sensor->empty()) end = std::max(end, sensor->back().time_us);
  for (const Trajectory& trajectory : drive)
    if (!trajectory.empty()) begin = std::min(begin, trajectory.front().time_us);
  // the same shift for all sensors keeps them synchronised
  const std::int64_t shift = end - begin + gap_us;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    for (const StampedPose& pose : drive[i]) sensors[i]->push_back({pose.time_us + shift, pose.pose});
}

}  // namespace egocal::tools
