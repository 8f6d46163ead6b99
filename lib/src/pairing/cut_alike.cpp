// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/cut_alike.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "statistics/order_statistic.hpp"

namespace egocal::detail {

namespace {

/// A pose between its neighbours.
struct Corner {
  DualQuaternion from, to;             ///< motions to the pose, and from it
  double before_us = 0, after_us = 0;  ///< their times
};

/// The corner of the path at a pose; empty where a neighbour is too far away.
std::optional<Corner> corner_at(const Neighbours& neighbours, std::int64_t max_gap_us) {
  const StampedPose& pose = neighbours.pose;
  const std::int64_t before_us = pose.time_us - neighbours.before.time_us,
                     after_us = neighbours.after.time_us - pose.time_us;
  if (before_us <= 0 || before_us > max_gap_us || after_us <= 0 || after_us > max_gap_us) return std::nullopt;
  return Corner{conjugate(neighbours.before.pose) * pose.pose, conjugate(pose.pose) * neighbours.after.pose,
                static_cast<double>(before_us), static_cast<double>(after_us)};
}

/// The product of the times to both poses that are interpolated [us^2].
double sides_of(const InterpolatedPart& interpolated) {
  return interpolated.part * (1 - interpolated.part) * interpolated.gap_us * interpolated.gap_us;
}

/// sides: product of the times to both poses that are interpolated [us^2]. typical: step of the stream.
DualQuaternion cut(const DualQuaternion& pose, const Corner& corner, double sides, const KeyStep& typical,
                   const SynchroniserOptions& options) {
  const double part = sides / (corner.before_us * corner.after_us);
  if (!(part <= options.most_cut)) return pose;
  const DualQuaternion bend = canonical_sign(
      conjugate(corner.from) * interpolate(DualQuaternion{}, corner.from * corner.to,
                                           corner.before_us / (corner.before_us + corner.after_us)));
  const KeyStep off = step_of(bend);
  const bool smooth =
      off.length <= options.most_bent * typical.length && off.angle <= options.most_bent * typical.angle;
  if (!smooth || (off.length == 0 && off.angle == 0)) return pose;
  return normalized(pose * interpolate(DualQuaternion{}, bend, part));
}

}  // namespace

KeyStep step_of(const DualQuaternion& motion) {
  return {translation_length(motion), rotation_angle(motion)};
}

KeyStep typical(const std::deque<KeyStep>& steps) {
  if (steps.empty()) return {};
  std::vector<double> lengths, angles;
  for (const KeyStep& step : steps) {
    lengths.push_back(step.length);
    angles.push_back(step.angle);
  }
  return {order_statistic(lengths, steps.size() / 2), order_statistic(angles, steps.size() / 2)};
}

DualQuaternion cut_alike(const Neighbours& neighbours, const InterpolatedPart& interpolated,
                         const KeyStep& typical, const SynchroniserOptions& options) {
  const DualQuaternion& pose = neighbours.pose.pose;
  const std::optional<Corner> corner = corner_at(neighbours, interpolated.max_gap_us);
  return corner ? cut(pose, *corner, sides_of(interpolated), typical, options) : pose;
}

DualQuaternion cut_alike(const Neighbours& neighbours, const InterpolatedPart& interpolated,
                         const SynchroniserOptions& options) {
  const DualQuaternion& pose = neighbours.pose.pose;
  const std::optional<Corner> corner = corner_at(neighbours, interpolated.max_gap_us);
  if (!corner) return pose;
  const KeyStep from = step_of(corner->from), to = step_of(corner->to);
  return cut(pose, *corner, sides_of(interpolated),
             {std::min(from.length, to.length), std::min(from.angle, to.angle)}, options);
}

}  // namespace egocal::detail
