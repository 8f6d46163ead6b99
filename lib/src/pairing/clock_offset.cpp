// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/clock_offset.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "egocal/microseconds.hpp"

namespace egocal {

namespace {

std::int64_t us(double seconds) {
  return std::llround(seconds * 1e6);
}

bool good(const TimeOffset& offset, const ClockOptions& options) {
  return offset.correlation >= options.least_correlation && offset.stddev <= options.largest_stddev &&
         offset.inliers >= options.least_inliers;
}

/// The poses of a stream in (begin, end] since its begin.
Trajectory part(const ClockState::Stream& stream, std::int64_t begin, std::int64_t end) {
  Trajectory result;
  for (const StampedPose& pose : stream.window) {
    const std::int64_t since = pose.time_us - *stream.begin_us;
    if (since > begin && since <= end) result.push_back(pose);
  }
  return result;
}

}  // namespace

ClockFollower::ClockFollower(const PairingOptions& options) : ClockFollower(options, ClockState{}) {}

ClockFollower::ClockFollower(const PairingOptions& options, ClockState state)
    : options_(options.clock), max_gap_(options.max_gap), state_(std::move(state)) {
  if (state_.next_us == 0) state_.next_us = us(options_.first + options_.phase * options_.delay);
}

ClockFollower::ClockFollower(const ClockFollower& other)
    : options_(other.options_), max_gap_(other.max_gap_), state_(other.state_) {}

ClockFollower& ClockFollower::operator=(const ClockFollower& other) {
  if (this != &other) *this = ClockFollower(other);
  return *this;
}

std::vector<ReleasedPose> ClockFollower::push(Side side, const StampedPose& pose) {
  ClockState::Stream& stream = state_.streams[side == Side::a ? 0 : 1];
  std::vector<ReleasedPose> released;
  if (!admit(stream, pose)) return released;
  stream.held.push_back(pose);
  const std::int64_t spacing = us(TimeOffsetOptions{}.least_spacing);
  if (stream.window.empty() || pose.time_us - stream.window.back().time_us >= spacing)
    stream.window.push_back(pose);
  if (!search_ && both_reached(state_.next_us)) begin_search();
  if (search_) search_->step(options_.work_per_pose);
  while (both_reached(boundary_us())) conclude(released);
  if (state_.in_force) release(released);
  forget();
  return released;
}

/// Whether the pose is near the others of its stream in time. A pose that is not waits for the next one: if
/// both agree the clock was set, otherwise the pose is dropped.
bool ClockFollower::admit(ClockState::Stream& stream, const StampedPose& pose) {
  const auto far = [this](std::int64_t x, std::int64_t y) { return std::abs(x - y) > us(options_.longest); };
  if (stream.newest_us && far(pose.time_us, *stream.newest_us)) {
    const bool confirmed = stream.stray && !far(pose.time_us, stream.stray->time_us);
    if (stream.stray) ++state_.given_up;
    stream.stray = pose;
    if (!confirmed) return false;
    restart();
  } else if (stream.stray) {
    ++state_.given_up;
    stream.stray.reset();
  }
  if (!stream.begin_us) stream.begin_us = stream.newest_us = pose.time_us;
  stream.newest_us = std::max(*stream.newest_us, pose.time_us);
  return true;
}

void ClockFollower::restart() {
  for (ClockState::Stream& stream : state_.streams) {
    state_.given_up += stream.held.size();
    stream = {};
  }
  search_.reset();
  state_.next_us = us(options_.first + options_.phase * options_.delay);
  state_.near = false;
  if (state_.in_force) ++state_.changes;
  state_.in_force.reset();
}

bool ClockFollower::both_reached(std::int64_t since_begin_us) const {
  return std::all_of(state_.streams.begin(), state_.streams.end(), [&](const ClockState::Stream& stream) {
    return stream.begin_us && *stream.newest_us - *stream.begin_us >= since_begin_us;
  });
}

std::int64_t ClockFollower::boundary_us() const {
  return state_.next_us + us(options_.delay);
}

void ClockFollower::begin_search() {
  TimeOffsetOptions options;
  options.max_gap = max_gap_;
  if (state_.near) options.near = *seconds();
  // streams with different beginnings overlap only in the longer window
  const std::int64_t begin = state_.next_us - us(state_.in_force ? options_.window : options_.longest);
  search_ = std::make_unique<TimeOffsetSearch>(part(state_.streams[0], begin, state_.next_us),
                                               part(state_.streams[1], begin, state_.next_us), options);
}

/// The estimate comes into force for all poses after the boundary.
void ClockFollower::conclude(std::vector<ReleasedPose>& released) {
  if (state_.in_force) release(released);
  if (!search_) begin_search();
  const std::optional<TimeOffset> offset = search_->finish();
  search_.reset();
  if (offset) state_.newest = offset;
  const bool trusted = offset && good(*offset, options_);
  const bool first = trusted && !state_.in_force;
  state_.near = trusted;
  if (first) {
    take_force(*offset);
    return;
  }
  if (trusted) {
    const std::int64_t end_us = *state_.streams[1].begin_us + state_.next_us;
    const double since = to_seconds(end_us - offset->at_us);
    const double change =
        std::abs(to_seconds(on_clock_of_a(*offset, end_us) - on_clock_of_a(*state_.in_force, end_us)));
    const double stddev =
        offset->drifts ? std::hypot(offset->stddev, since * offset->rate_stddev) : offset->stddev;
    if (change >= options_.least_change && change >= options_.change_sigmas * stddev) {
      state_.in_force = offset;
      ++state_.changes;
    }
  }
  state_.next_us += us(state_.in_force ? options_.every : options_.first);
}

/// On the first estimate: from now on the times of both streams count from the same instant.
void ClockFollower::take_force(const TimeOffset& offset) {
  ClockState::Stream& b = state_.streams[1];
  const std::int64_t begin_us = *state_.streams[0].begin_us - us(offset.seconds);
  const std::int64_t later_us = *b.begin_us - begin_us;
  b.begin_us = begin_us;
  state_.next_us = std::max(state_.next_us, state_.next_us + later_us) + us(options_.every);
  state_.in_force = offset;
  ++state_.changes;
}

/// Releases the held poses up to the boundary, in the order of time on the clock of a.
void ClockFollower::release(std::vector<ReleasedPose>& released) {
  const std::size_t first = released.size();
  for (const Side side : {Side::a, Side::b}) {
    ClockState::Stream& stream = state_.streams[side == Side::a ? 0 : 1];
    std::deque<StampedPose> later;
    for (StampedPose pose : stream.held) {
      if (pose.time_us - *stream.begin_us > boundary_us()) {
        later.push_back(pose);
        continue;
      }
      if (side == Side::b) pose.time_us = on_clock_of_a(*state_.in_force, pose.time_us);
      released.push_back({side, pose, state_.changes});
    }
    stream.held = std::move(later);
  }
  std::stable_sort(
      released.begin() + static_cast<std::ptrdiff_t>(first), released.end(),
      [](const ReleasedPose& x, const ReleasedPose& y) { return x.pose.time_us < y.pose.time_us; });
}

/// Keeps memory bounded, by time and by number.
void ClockFollower::forget() {
  const std::int64_t longest_us = us(options_.longest);
  for (ClockState::Stream& stream : state_.streams) {
    while (!stream.held.empty() && (stream.held.size() > options_.most_held ||
                                    *stream.newest_us - stream.held.front().time_us > longest_us)) {
      stream.held.pop_front();
      ++state_.given_up;
    }
    while (!stream.window.empty() &&
           (stream.window.front().time_us - *stream.begin_us <= state_.next_us - longest_us ||
            *stream.newest_us - stream.window.front().time_us > 2 * longest_us))
      stream.window.pop_front();
  }
}

std::optional<double> ClockFollower::seconds() const {
  if (!state_.in_force) return std::nullopt;
  const std::int64_t now_us = state_.streams[1].newest_us.value_or(state_.in_force->at_us);
  return to_seconds(on_clock_of_a(*state_.in_force, now_us) - now_us);
}

}  // namespace egocal
