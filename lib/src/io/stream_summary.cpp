// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/stream_summary.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/microseconds.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal {

namespace {

constexpr std::size_t kept_steps = 4096;  // a limit on memory: the median of these is known to 2 %

}  // namespace

void StreamSummariser::add(const StampedPose& pose) {
  if (summary_.poses++ == 0) {
    summary_.first_us = summary_.last_us = pose.time_us;
    last_ = pose;
    return;
  }
  summary_.first_us = std::min(summary_.first_us, pose.time_us);
  summary_.last_us = std::max(summary_.last_us, pose.time_us);
  const double step = to_seconds(pose.time_us - last_->time_us);
  if (step <= 0) {
    ++summary_.out_of_order;
    return;
  }
  if (steps_.size() < kept_steps) steps_.push_back(static_cast<float>(step));
  if (step > options_.least_gap && suspect_steps_.size() < 16 * kept_steps)
    suspect_steps_.push_back(static_cast<float>(step));
  const Pose motion = to_pose(conjugate(last_->pose) * pose.pose);
  const Eigen::Vector3d turn = rotation_log(motion.rotation);
  if (motion.translation.norm() > options_.largest_speed * step ||
      turn.norm() > options_.largest_turn_rate * step) {
    ++summary_.jumps;
  } else {
    summary_.path_length += motion.translation.norm();
    for (int i = 0; i < 3; ++i) summary_.turning[static_cast<std::size_t>(i)] += std::abs(turn[i]);
  }
  last_ = pose;
}

StreamSummary StreamSummariser::summary() const {
  StreamSummary summary = summary_;
  const auto step = static_cast<double>(detail::median(steps_));
  summary.rate = step > 0 ? 1 / step : 0;
  for (const float seconds : suspect_steps_)
    if (static_cast<double>(seconds) > options_.gap_factor * step) {
      ++summary.gaps;
      summary.longest_gap = std::max(summary.longest_gap, static_cast<double>(seconds));
    }
  return summary;
}

}  // namespace egocal
