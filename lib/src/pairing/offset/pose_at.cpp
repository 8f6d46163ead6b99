// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/offset/pose_at.hpp"

#include <algorithm>
#include <span>

#include "egocal/motions/instant.hpp"
#include "pairing/smooth_interpolation.hpp"

namespace egocal::detail {

std::optional<DualQuaternion> pose_at(const Trajectory& trajectory, std::int64_t at_us, double time_us,
                                      double max_gap_us, std::size_t& from,
                                      const SynchroniserOptions& options) {
  const auto since = [&](std::size_t i) { return static_cast<double>(trajectory[i].time_us - at_us); };
  while (from + 1 < trajectory.size() && since(from + 1) <= time_us) ++from;
  if (from + 1 >= trajectory.size() || since(from) > time_us) return std::nullopt;
  const double gap = since(from + 1) - since(from);
  if (gap > max_gap_us) return std::nullopt;
  const double part = (time_us - since(from)) / gap;
  const std::size_t side = options.smooth_poses / 2;
  if (part > 0 && from + 1 >= side && from + side < trajectory.size())
    if (const auto smooth = interpolate_smoothly(
            std::span(trajectory).subspan(from + 1 - side, options.smooth_poses), part, options))
      return smooth;
  return interpolate(trajectory[from].pose, trajectory[from + 1].pose, part);
}

std::size_t first_before(const Trajectory& trajectory, std::int64_t at_us, double time_us) {
  const auto after = std::upper_bound(trajectory.begin(), trajectory.end(), time_us,
                                      [at_us](double time, const StampedPose& pose) {
                                        return time < static_cast<double>(pose.time_us - at_us);
                                      });
  return after == trajectory.begin() ? 0 : static_cast<std::size_t>(after - trajectory.begin()) - 1;
}

}  // namespace egocal::detail
