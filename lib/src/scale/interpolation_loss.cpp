// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/scale/interpolation_loss.hpp"

#include <algorithm>
#include <utility>

#include "egocal/geometry/pose.hpp"
#include "egocal/microseconds.hpp"

namespace egocal {

namespace {

std::size_t index(Side side) {
  return side == Side::a ? 0 : 1;
}

}  // namespace

InterpolationLoss::InterpolationLoss(const InterpolationLossOptions& options)
    : InterpolationLoss(options, InterpolationLossState()) {}

InterpolationLoss::InterpolationLoss(const InterpolationLossOptions& options, InterpolationLossState state)
    : options_(options), state_(std::move(state)) {}

void InterpolationLoss::stamp(Side side, std::int64_t time_us) {
  std::deque<std::int64_t>& stamps = state_.stamps[index(side)];
  stamps.push_back(time_us);
  if (stamps.size() > options_.most_stamps) stamps.pop_front();
}

/// The stamps up to the end of the step: all of them are there, since an instant needs poses of both streams
/// that are not older.
void InterpolationLoss::count(const MotionPair& step, Side keys) {
  ++state_.steps;
  std::deque<std::int64_t>& others = state_.stamps[1 - index(keys)];
  bool together = false;
  for (; !others.empty() && others.front() <= step.end_us; others.pop_front()) {
    ++state_.passed;
    together = together || others.front() == step.end_us;
  }
  state_.together += together ? 1 : 0;
  std::deque<std::int64_t>& own = state_.stamps[index(keys)];
  while (!own.empty() && own.front() <= step.end_us) own.pop_front();
}

void InterpolationLoss::step(const MotionPair& step, Side keys) {
  count(step, keys);
  const auto motion_of = [keys](const MotionPair& pair) { return keys == Side::a ? pair.a : pair.b; };
  std::vector<InterpolationLossState::Open>& open = state_.open;
  if (state_.previous && state_.previous->end_us != step.begin_us) {
    state_.previous.reset();
    open.clear();
  }
  if (state_.previous) {
    // the instant between both steps, interpolated from its neighbours, seen from where it was
    const DualQuaternion before = motion_of(*state_.previous), after = motion_of(step);
    const double at = to_seconds(state_.previous->end_us - state_.previous->begin_us) /
                      to_seconds(step.end_us - state_.previous->begin_us);
    const Eigen::Vector3d miss =
        to_pose(conjugate(before) * interpolate(DualQuaternion{}, before * after, at)).translation;
    // an odometry that jumps, or a vehicle that stands or leaves, is no path that interpolation follows
    if (miss.norm() > std::min(to_pose(before).translation.norm(), to_pose(after).translation.norm())) {
      open.clear();
    } else {
      const double length = options_.motion - 0.5 * to_seconds(step.end_us - step.begin_us);
      while (!open.empty() && to_seconds(step.begin_us - open.front().begin_us) >= length) {
        const Pose motion = to_pose(open.front().motion);
        state_.lost += motion.translation.dot(open.front().miss - motion.rotation * miss);
        state_.energy += motion.translation.squaredNorm();
        open.erase(open.begin());
      }
      const double distance =
          options_.motion / static_cast<double>(std::max<std::size_t>(1, options_.starts));
      if (open.empty() || to_seconds(step.begin_us - open.back().begin_us) >= distance)
        open.push_back({DualQuaternion{}, miss, step.begin_us});
    }
  }
  for (InterpolationLossState::Open& one : open) one.motion = one.motion * motion_of(step);
  state_.previous = step;
}

double InterpolationLoss::part() const {
  if (!(state_.energy > 0) || state_.steps == 0) return 0;
  const auto steps = static_cast<double>(state_.steps);
  const double periods = state_.passed > state_.steps ? steps / static_cast<double>(state_.passed) : 1;
  const double interpolated = 1 - static_cast<double>(state_.together) / steps;
  const double share = options_.cut_alike ? options_.share : options_.share_not_cut;
  return share * periods * interpolated * std::clamp(state_.lost / state_.energy, 0.0, 1.0);
}

}  // namespace egocal
