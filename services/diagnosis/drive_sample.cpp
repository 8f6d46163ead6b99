// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/drive_sample.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/bus/check.hpp"

namespace egocal::services {

namespace {

/// A limit on the shift: 2^30 stretches of ten seconds are three centuries.
constexpr int highest_level = 30;

}  // namespace

void DriveSample::push(Side side, const StampedPose& pose) {
  Trajectory& poses = of(side);
  if (!poses.empty() && pose.time_us - poses.back().time_us < options_.least_distance_us) return;
  if (!origin_us_) origin_us_ = pose.time_us + offset_of(side);
  poses.push_back(pose);
  if (full()) thin();
  EGOCAL_CHECK(!full(), "the sample of a drive is bounded");
}

bool DriveSample::full() const {
  return std::min(a_.size(), b_.size()) > options_.most_poses ||
         std::max(a_.size(), b_.size()) > options_.most_poses * options_.most_of_faster;
}

void DriveSample::begin_anew(Side side) {
  const bool second = begun_anew_ && *begun_anew_ != side;
  of(side).clear();
  if (second) {
    begun_anew_.reset();
    return;
  }
  a_.clear();
  b_.clear();
  origin_us_.reset();
  level_ = 0;
  begun_anew_ = side;
}

void DriveSample::begin_session(std::int64_t time_us) {
  for (Trajectory* poses : {&a_, &b_})
    std::erase_if(*poses, [time_us](const StampedPose& pose) { return pose.time_us < time_us; });
  begun_anew_.reset();
  origin_us_.reset();
  for (const Side side : {Side::a, Side::b})
    if (!poses(side).empty()) {
      const std::int64_t first = poses(side).front().time_us + offset_of(side);
      origin_us_ = std::min(first, origin_us_.value_or(first));
    }
  if (!origin_us_) level_ = 0;
}

void DriveSample::set_time_offset(double seconds) {
  time_offset_us_ = std::llround(1e6 * seconds);
}

void DriveSample::thin() {
  for (thin(Side::a), thin(Side::b); full() && level_ < highest_level; thin(Side::a), thin(Side::b)) ++level_;
  // more in the newest stretch than there is room for, which least_distance_us rules out for sane options
  if (!full()) return;
  for (Trajectory* poses : {&a_, &b_})
    if (poses->size() > options_.most_poses)
      poses->erase(poses->begin(), poses->end() - static_cast<std::ptrdiff_t>(options_.most_poses));
}

void DriveSample::thin(Side side) {
  Trajectory& poses = of(side);
  if (poses.empty()) return;
  const std::int64_t recent = poses.back().time_us - options_.recent_us;
  const std::int64_t origin = origin_us_.value_or(0) - offset_of(side);
  const std::int64_t mask = (std::int64_t{1} << level_) - 1;
  std::erase_if(poses, [&](const StampedPose& pose) {
    const std::int64_t stretch = (pose.time_us - origin) / options_.stretch_us;
    return pose.time_us < recent && (stretch & mask) != 0;
  });
}

}  // namespace egocal::services
