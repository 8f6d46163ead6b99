// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/clock_offset.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "egocal/microseconds.hpp"

namespace egocal {

namespace {

/// Held poses that are released at each pose: those of the first ten seconds within two. Pairing eight takes
/// a tenth of a millisecond.
constexpr std::size_t released_at_once = 8;
constexpr std::size_t without_limit = std::numeric_limits<std::size_t>::max();

using Window = std::deque<StampedPose>;

/// The first pose of a stream's window after a time since its begin.
Window::const_iterator first_after(const ClockState::Stream& stream, std::int64_t since_begin_us) {
  return std::upper_bound(stream.window.begin(), stream.window.end(), *stream.begin_us + since_begin_us,
                          [](std::int64_t time, const StampedPose& pose) { return time < pose.time_us; });
}

/// Time since the begin of both at which the streams have gone on by so many poses after `from`.
std::int64_t time_of(const std::array<ClockState::Stream, 2>& streams, std::int64_t from, std::size_t poses) {
  Window::const_iterator i = first_after(streams[0], from), j = first_after(streams[1], from);
  std::int64_t time = from;
  for (; poses > 0; --poses) {
    const bool no_a = i == streams[0].window.end(), no_b = j == streams[1].window.end();
    if (no_a && no_b) break;
    const std::int64_t a = no_a ? 0 : i->time_us - *streams[0].begin_us,
                       b = no_b ? 0 : j->time_us - *streams[1].begin_us;
    const bool from_a = no_b || (!no_a && a <= b);
    time = from_a ? a : b;
    from_a ? ++i : ++j;
  }
  return time;
}

/// The poses of a stream in (begin, end] since its begin.
Trajectory part(const ClockState::Stream& stream, std::int64_t begin, std::int64_t end) {
  return {first_after(stream, begin), first_after(stream, end)};
}

}  // namespace

bool is_trusted(const TimeOffset& offset, const ClockOptions& options) {
  return offset.correlation >= options.least_correlation && offset.stddev <= options.largest_stddev &&
         offset.inliers >= options.least_inliers;
}

bool is_another_clock(double change, double stddev, const ClockOptions& options) {
  return change >= options.least_change && change >= options.change_sigmas * stddev;
}

ClockFollower::ClockFollower(const PairingOptions& options) : ClockFollower(options, ClockState{}) {}

ClockFollower::ClockFollower(const PairingOptions& options, ClockState state)
    : options_(options.clock), max_gap_(options.max_gap), state_(std::move(state)) {
  if (state_.next_us == 0) state_.next_us = to_microseconds(options_.first + options_.phase * options_.delay);
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
  const auto later = [](const StampedPose& one, const StampedPose& other) {
    return one.time_us < other.time_us;
  };
  stream.held.insert(std::upper_bound(stream.held.begin(), stream.held.end(), pose, later), pose);
  const std::int64_t spacing = to_microseconds(TimeOffsetOptions{}.least_spacing);
  if (stream.window.empty() || pose.time_us - stream.window.back().time_us >= spacing)
    stream.window.push_back(pose);
  search_on();
  while (due()) conclude(time_of(state_.streams, state_.next_us, search_->steps()), released);
  if (state_.in_force) release(std::max(boundary_us(), common_us()), released_at_once, released);
  forget();
  return released;
}

/// The clock of a pose is the one in force up to here, whatever comes later: the next estimate counts after
/// it.
bool ClockFollower::can_release() const {
  if (!state_.in_force) return false;
  const std::int64_t until_us = std::max(boundary_us(), common_us());
  return std::any_of(state_.streams.begin(), state_.streams.end(),
                     [&](const ClockState::Stream& stream) { return may_be_used(stream, until_us); });
}

std::vector<ReleasedPose> ClockFollower::release_held() {
  std::vector<ReleasedPose> released;
  if (can_release()) release(std::max(boundary_us(), common_us()), without_limit, released);
  return released;
}

std::vector<ReleasedPose> ClockFollower::finish() {
  std::vector<ReleasedPose> released;
  while (both_reached(boundary_us())) {
    if (!search_) begin_search();
    search_->finish();
    conclude(common_us(), released);
  }
  if (state_.in_force) release(std::max(boundary_us(), common_us()), without_limit, released);
  return released;
}

/// One share of the estimate at each pose; all shares that both streams have gone on by, where one was ahead
/// of the other, or where a copy begins again.
void ClockFollower::search_on() {
  if (!both_reached(state_.next_us)) return;
  if (!search_) begin_search();
  search_->step(options_.work_per_pose);
  const std::size_t shares = this->shares();
  while (!search_->finished() && search_->steps() < shares) search_->step(options_.work_per_pose);
}

/// Poses by which both streams have gone on since the end of the estimate's streams.
std::size_t ClockFollower::shares() const {
  std::ptrdiff_t poses = 0;
  for (const ClockState::Stream& stream : state_.streams)
    poses += first_after(stream, common_us()) - first_after(stream, state_.next_us);
  return static_cast<std::size_t>(poses);
}

/// Whether the estimate comes into force now.
bool ClockFollower::due() {
  if (!both_reached(boundary_us())) return false;
  if (!search_) search_on();
  return search_->finished() && search_->steps() <= shares();
}

/// Whether the pose is near the others of its stream in time. A pose that is not waits for the next one: if
/// both agree the clock was set, otherwise the pose is dropped.
bool ClockFollower::admit(ClockState::Stream& stream, const StampedPose& pose) {
  const auto far = [this](std::int64_t x, std::int64_t y) {
    return std::abs(x - y) > to_microseconds(options_.longest);
  };
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
  state_.next_us = to_microseconds(options_.first + options_.phase * options_.delay);
  state_.near = false;
  if (state_.in_force) ++state_.changes;
  state_.in_force.reset();
}

bool ClockFollower::both_reached(std::int64_t since_begin_us) const {
  return std::all_of(state_.streams.begin(), state_.streams.end(), [&](const ClockState::Stream& stream) {
    return stream.begin_us && *stream.newest_us - *stream.begin_us >= since_begin_us;
  });
}

/// Time since the begin that both streams have reached; both have begun.
std::int64_t ClockFollower::common_us() const {
  const auto reached = [](const ClockState::Stream& stream) { return *stream.newest_us - *stream.begin_us; };
  return std::min(reached(state_.streams[0]), reached(state_.streams[1]));
}

/// The estimate comes into force here at the earliest.
std::int64_t ClockFollower::boundary_us() const {
  return state_.next_us + to_microseconds(options_.delay);
}

void ClockFollower::begin_search() {
  TimeOffsetOptions options;
  options.max_gap = max_gap_;
  if (state_.near) {
    // at the end of the streams: the newest pose may be any
    const std::int64_t end_us = *state_.streams[1].begin_us + state_.next_us;
    options.near = to_seconds(on_clock_of_a(*state_.in_force, end_us) - end_us);
  }
  // streams with different beginnings overlap only in the longer window
  const std::int64_t begin =
      state_.next_us - to_microseconds(state_.in_force ? options_.window : options_.longest);
  search_ = std::make_unique<TimeOffsetSearch>(part(state_.streams[0], begin, state_.next_us),
                                               part(state_.streams[1], begin, state_.next_us), options);
}

/// The finished estimate comes into force for all poses after the boundary, and after the time of the pose
/// that its last share was worked out at.
void ClockFollower::conclude(std::int64_t worked_us, std::vector<ReleasedPose>& released) {
  if (state_.in_force) release(std::max(boundary_us(), worked_us), without_limit, released);
  const std::optional<TimeOffset> offset = search_->finish();
  search_.reset();
  if (offset) state_.newest = offset;
  const bool trusted = offset && is_trusted(*offset, options_);
  const bool first = trusted && !state_.in_force;
  state_.near = trusted;
  if (first) {
    take_force(*offset, worked_us);
    return;
  }
  if (trusted) {
    const std::int64_t end_us = *state_.streams[1].begin_us + state_.next_us;
    const double since = to_seconds(end_us - offset->at_us);
    const double change =
        std::abs(to_seconds(on_clock_of_a(*offset, end_us) - on_clock_of_a(*state_.in_force, end_us)));
    const double stddev =
        offset->drifts ? std::hypot(offset->stddev, since * offset->rate_stddev) : offset->stddev;
    if (is_another_clock(change, stddev, options_)) {
      state_.in_force = offset;
      ++state_.changes;
    }
  }
  // the shares of the next one begin with it
  do {
    state_.next_us += to_microseconds(state_.in_force ? options_.every : options_.first);
  } while (state_.next_us < worked_us);
}

/// On the first estimate: from now on the times of both streams count from the same instant.
void ClockFollower::take_force(const TimeOffset& offset, std::int64_t worked_us) {
  ClockState::Stream& b = state_.streams[1];
  const std::int64_t begin_us = *state_.streams[0].begin_us - to_microseconds(offset.seconds);
  const std::int64_t later_us = *b.begin_us - begin_us;
  b.begin_us = begin_us;
  const std::int64_t concluded_us = std::max(state_.next_us, worked_us);
  state_.next_us = std::max(concluded_us, concluded_us + later_us) + to_microseconds(options_.every);
  state_.in_force = offset;
  ++state_.changes;
}

/// Whether the first of its held poses lies up to a time since the begin.
bool ClockFollower::may_be_used(const ClockState::Stream& stream, std::int64_t until_us) const {
  return !stream.held.empty() && stream.held.front().time_us - *stream.begin_us <= until_us;
}

/// Releases held poses up to a time since the begin, in the order of time on the clock of a.
void ClockFollower::release(std::int64_t until_us, std::size_t most, std::vector<ReleasedPose>& released) {
  const auto next = [&](Side side) -> std::optional<StampedPose> {
    const ClockState::Stream& stream = state_.streams[side == Side::a ? 0 : 1];
    if (!may_be_used(stream, until_us)) return std::nullopt;
    StampedPose pose = stream.held.front();
    if (side == Side::b) pose.time_us = on_clock_of_a(*state_.in_force, pose.time_us);
    return pose;
  };
  for (std::size_t i = 0; i < most; ++i) {
    const std::optional<StampedPose> a = next(Side::a), b = next(Side::b);
    if (!a && !b) return;
    const Side side = a && (!b || a->time_us <= b->time_us) ? Side::a : Side::b;
    released.push_back({side, side == Side::a ? *a : *b, state_.changes});
    state_.streams[side == Side::a ? 0 : 1].held.pop_front();
  }
}

/// Keeps memory bounded, by time and by number.
void ClockFollower::forget() {
  const std::int64_t longest_us = to_microseconds(options_.longest),
                     held_us = longest_us +
                               to_microseconds(state_.in_force ? options_.every : 0);  // while being released
  for (ClockState::Stream& stream : state_.streams) {
    while (!stream.held.empty() && (stream.held.size() > options_.most_held ||
                                    *stream.newest_us - stream.held.front().time_us > held_us)) {
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
