// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/cut_alike.hpp"

#include <vector>

#include "statistics/order_statistic.hpp"

namespace egocal::detail {

namespace {

/// Medians.
KeyStep typical(const std::deque<KeyStep>& steps) {
  std::vector<double> lengths, angles;
  for (const KeyStep& step : steps) {
    lengths.push_back(step.length);
    angles.push_back(step.angle);
  }
  return {order_statistic(lengths, steps.size() / 2), order_statistic(angles, steps.size() / 2)};
}

}  // namespace

DualQuaternion cut_alike(const Neighbours& neighbours, const Interpolated& interpolated,
                         std::deque<KeyStep>& steps, const SynchroniserOptions& options) {
  const StampedPose& pose = neighbours.pose;
  const std::int64_t before_us = pose.time_us - neighbours.before.time_us,
                     after_us = neighbours.after.time_us - pose.time_us;
  if (before_us <= 0 || before_us > interpolated.max_gap_us || after_us <= 0 ||
      after_us > interpolated.max_gap_us)
    return pose.pose;
  const DualQuaternion from = conjugate(neighbours.before.pose) * pose.pose,
                       to = conjugate(pose.pose) * neighbours.after.pose;
  steps.push_back({translation_length(from), rotation_angle(from)});
  if (steps.size() > options.typical_steps) steps.pop_front();

  const auto h_before = static_cast<double>(before_us), h_after = static_cast<double>(after_us);
  const double cut = static_cast<double>(pose.time_us - interpolated.from_us) *
                     static_cast<double>(interpolated.to_us - pose.time_us) / (h_before * h_after);
  if (!(cut <= options.most_cut)) return pose.pose;
  const DualQuaternion bend = canonical_sign(
      conjugate(from) * interpolate(DualQuaternion{}, from * to, h_before / (h_before + h_after)));
  const double length = translation_length(bend), angle = rotation_angle(bend);
  const KeyStep step = typical(steps);
  const bool smooth = length <= options.most_bent * step.length && angle <= options.most_bent * step.angle;
  if (!smooth || (length == 0 && angle == 0)) return pose.pose;
  return normalized(pose.pose * interpolate(DualQuaternion{}, bend, cut));
}

}  // namespace egocal::detail
