// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/drive_sample.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "egocal/bus/check.hpp"
#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::services {

namespace {

/// Limit of the shift: 2^30 stretches of ten seconds are three centuries.
constexpr int highest_level = 30;

}  // namespace

void DriveSample::push(Side side, const StampedPose& pose) {
  Trajectory& poses = of(side);
  if (!poses.empty() && pose.time_us - poses.back().time_us < options_.least_distance_us) return;
  if (!state_.origin_us) state_.origin_us = pose.time_us + offset_of(side);
  poses.push_back(pose);
  if (full()) thin();
  EGOCAL_CHECK(!full(), "the sample of a drive is bounded");
}

bool DriveSample::full(const DriveSampleState& state, const DriveSampleOptions& options) {
  return std::min(state.a.size(), state.b.size()) > options.most_poses ||
         std::max(state.a.size(), state.b.size()) > options.most_poses * options.most_of_faster;
}

void DriveSample::restore(DriveSampleState state) {
  const auto possible = [&](const Trajectory& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (!plausible_time(poses[i].time_us) || !poses[i].pose.vec().allFinite() ||
          (i > 0 && poses[i].time_us <= poses[i - 1].time_us))
        return false;
    return true;
  };
  const bool fits = !full(state, options_) && possible(state.a) && possible(state.b) && state.level >= 0 &&
                    state.level <= highest_level &&
                    (!state.origin_us || std::abs(*state.origin_us) <= 2 * limits::latest_us) &&
                    std::abs(state.time_offset_us) <= limits::latest_us &&
                    (!state.begun_anew || *state.begun_anew == Side::a || *state.begun_anew == Side::b);
  if (!fits) throw Error("holds poses that no drive can have");
  state_ = std::move(state);
}

void DriveSample::begin_anew(Side side) {
  const bool second = state_.begun_anew && *state_.begun_anew != side;
  of(side).clear();
  if (second) {
    state_.begun_anew.reset();
    return;
  }
  state_.a.clear();
  state_.b.clear();
  state_.origin_us.reset();
  state_.level = 0;
  state_.begun_anew = side;
}

void DriveSample::begin_session(std::int64_t time_us) {
  for (const Side side : {Side::a, Side::b})
    std::erase_if(of(side), [time_us, offset = offset_of(side)](const StampedPose& pose) {
      return pose.time_us + offset < time_us;
    });
  state_.begun_anew.reset();
  state_.origin_us.reset();
  for (const Side side : {Side::a, Side::b})
    if (!poses(side).empty()) {
      const std::int64_t first = poses(side).front().time_us + offset_of(side);
      state_.origin_us = std::min(first, state_.origin_us.value_or(first));
    }
  if (!state_.origin_us) state_.level = 0;
}

void DriveSample::set_time_offset(double seconds) {
  state_.time_offset_us = to_microseconds(seconds);
}

void DriveSample::thin() {
  for (thin(Side::a), thin(Side::b); full() && state_.level < highest_level; thin(Side::a), thin(Side::b))
    ++state_.level;
  // only with options in which least_distance_us does not bound the poses of the newest stretch
  if (!full()) return;
  for (Trajectory* poses : {&state_.a, &state_.b})
    if (poses->size() > options_.most_poses)
      poses->erase(poses->begin(), poses->end() - static_cast<std::ptrdiff_t>(options_.most_poses));
}

void DriveSample::thin(Side side) {
  Trajectory& poses = of(side);
  if (poses.empty()) return;
  const std::int64_t recent = poses.back().time_us - options_.recent_us;
  const std::int64_t origin = state_.origin_us.value_or(0) - offset_of(side);
  const std::int64_t mask = (std::int64_t{1} << state_.level) - 1;
  std::erase_if(poses, [&](const StampedPose& pose) {
    const std::int64_t stretch = (pose.time_us - origin) / options_.stretch_us;
    return pose.time_us < recent && (stretch & mask) != 0;
  });
}

}  // namespace egocal::services
