// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/stream_summary.hpp"

#include <algorithm>
#include <cmath>

namespace egocal {

namespace {

constexpr std::size_t kept_steps = 4096;  // a limit on memory: the median of these is known to 2 %

double median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

}  // namespace

void StreamSummariser::add(const StampedPose& pose) {
  if (summary_.poses++ == 0) {
    summary_.first_us = summary_.last_us = pose.time_us;
    last_ = pose;
    return;
  }
  summary_.first_us = std::min(summary_.first_us, pose.time_us);
  summary_.last_us = std::max(summary_.last_us, pose.time_us);
  const double seconds = 1e-6 * static_cast<double>(pose.time_us - last_->time_us);
  if (seconds <= 0) {
    ++summary_.out_of_order;
    return;
  }
  if (steps_.size() < kept_steps) steps_.push_back(static_cast<float>(seconds));
  if (seconds > options_.least_gap && suspect_steps_.size() < 16 * kept_steps)
    suspect_steps_.push_back(static_cast<float>(seconds));
  const Pose motion = to_pose(conjugate(last_->pose) * pose.pose);
  const Eigen::Vector3d turn = rotation_log(motion.rotation);
  if (motion.translation.norm() > options_.largest_speed * seconds ||
      turn.norm() > options_.largest_turn_rate * seconds) {
    ++summary_.jumps;
  } else {
    summary_.path_length += motion.translation.norm();
    for (int i = 0; i < 3; ++i) summary_.turning[static_cast<std::size_t>(i)] += std::abs(turn[i]);
  }
  last_ = pose;
}

StreamSummary StreamSummariser::summary() const {
  StreamSummary summary = summary_;
  const double step = median(steps_);
  summary.rate = step > 0 ? 1 / step : 0;
  for (const float seconds : suspect_steps_)
    if (static_cast<double>(seconds) > options_.gap_factor * step) {
      ++summary.gaps;
      summary.longest_gap = std::max(summary.longest_gap, static_cast<double>(seconds));
    }
  return summary;
}

}  // namespace egocal
