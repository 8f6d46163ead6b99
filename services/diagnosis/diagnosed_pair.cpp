// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/diagnosed_pair.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "egocal/bus/channels.hpp"
#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::services {

DiagnosedPair::DiagnosedPair(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::PairConfig& pair,
                             std::optional<Side> whose_scale, const DriveSampleOptions& options)
    : config(pair),
      unscaled(whose_scale),
      inbox(loop, heartbeat, pair),
      scales(loop, bus::scale_problem_channel(pair.a, pair.b)),
      sample(options) {}

void DiagnosedPair::begin_anew(Side side) {
  sample.begin_anew(side);
  if (newest) known.matched_before = newest->message.matched;
  forget_what_was_missed();
}

void DiagnosedPair::take_pose(Side side, const StampedPose& pose, std::int64_t mono_us) {
  if (paused) return;
  note_what_was_missed(side, pose);
  sample.push(side, pose);
  newest_pose_mono_us = mono_us;
}

/// Notes at the first pose of a stream after a restart what was missed: poses between the saved state and
/// this one are never judged.
void DiagnosedPair::note_what_was_missed(Side side, const StampedPose& pose) {
  if (!std::exchange(continues[side == Side::b], false) || sample.poses(side).empty()) return;
  const std::int64_t missed = pose.time_us - sample.poses(side).back().time_us;
  // both streams lack about the same time: it counts once
  if (continues[side != Side::b]) known.missed_us += std::max<std::int64_t>(0, missed);
}

void DiagnosedPair::forget_what_was_missed() {
  known.matched_between = known.missed_us = 0;
  continues[0] = continues[1] = false;
}

std::string DiagnosedPair::take_problem(std::int64_t mono_us) {
  std::string refused;
  scale_problem_t scale_problem{};
  if (unscaled && scales.take(scale_problem)) refused = scale.take(scale_problem);
  std::optional<ReceivedProblem> received = inbox.take();
  if (!received) return refused;
  const problem_t& message = received->message;
  const bool same_session = known.session == message.session;
  if (!same_session || !newest || newest->message.seq != message.seq) newest_mono_us = mono_us;
  sample.set_time_offset(message.time_offset);
  if (!same_session) {
    begin_session(message);
  } else if (!newest) {
    // the first one since the restart
    known.matched_between += std::max<std::int64_t>(0, message.matched - known.matched);
  }
  known.session = message.session;
  known.matched = message.matched;
  clock.add(message.utime, to_microseconds(message.time_offset));
  newest = std::move(received);
  return refused;
}

void DiagnosedPair::begin_session(const problem_t& message) {
  // if times ran backwards, the session number is no time, and the streams have started again
  if (message.session <= message.utime) sample.begin_session(message.session);
  clock.clear();
  judged_seq = -1;
  known.matched_before = message.matched;
  forget_what_was_missed();
  verdict.reset();
  judged.reset();
  error.clear();
}

void DiagnosedPair::restore(DriveSample saved_sample, FollowedClock saved_clock, PairMemory saved) {
  sample = std::move(saved_sample);
  clock = std::move(saved_clock);
  known = std::move(saved);
  continues[0] = continues[1] = true;
}

PairMemory DiagnosedPair::memory() const {
  PairMemory memory = known;
  memory.sample = sample.state();
  memory.offsets = clock.offsets();
  return memory;
}

bool DiagnosedPair::idle(std::int64_t mono_us, const DiagnosingOptions& options) const {
  return to_seconds(mono_us - newest_mono_us) >= options.idle;
}

bool DiagnosedPair::to_be_judged(std::int64_t mono_us, bool early, const DiagnosingOptions& options) const {
  if (!newest) return false;
  if (newest->message.seq != judged_seq) return !early || idle(mono_us, options);
  const bool more_poses = to_seconds(common_end_us() - judged_until_us) >= options.pose_step;
  const bool no_poses_come = to_seconds(mono_us - newest_pose_mono_us) >= options.idle;
  return more_poses && (!early || (idle(mono_us, options) && no_poses_come));
}

bool DiagnosedPair::left_what_was_judged(const DiagnosingOptions& options) {
  if (!judged || !newest) return false;
  const std::int64_t seq = newest->message.seq;
  if (seq == judged_seq || std::exchange(compared_seq, seq) == seq) return false;
  try {
    const Answer answer = solve(newest->problem, Method::dual);
    return deviations_from(*judged, answer.T_a_b) > options.far_from_judged;
  } catch (const std::exception&) {
    return true;  // judging it reports the error
  }
}

std::optional<double> DiagnosedPair::scale_in_force() const {
  return unscaled ? scale.in_force(config.a, config.b, newest->message.session) : 1;
}

/// At full speed many motions precede the first problem that is heard, but none precedes the first pose. If
/// one sensor starts later, its poses come late, but no motions are missed.
Unseen DiagnosedPair::unseen(std::size_t poses) const {
  const problem_t& message = newest->message;
  std::int64_t begin = message.session;
  for (const Side side : {Side::a, Side::b}) {
    const Trajectory& of_side = sample.poses(side);
    const std::int64_t offset = side == Side::b ? to_microseconds(message.time_offset) : 0;
    begin = std::max(begin, of_side.empty() ? message.utime : of_side.front().time_us + offset);
  }
  const auto part = [](double of_it, double all) { return all > 0 ? std::clamp(of_it / all, 0.0, 1.0) : 0; };
  const std::int64_t unseen_us = begin - message.session + known.missed_us;
  return {std::min(part(static_cast<double>(known.matched_before + known.matched_between),
                        static_cast<double>(message.matched)),
                   part(to_seconds(unseen_us), to_seconds(message.utime - message.session))),
          to_seconds(unseen_us), poses, known.missed_us > 0};
}

std::int64_t DiagnosedPair::common_end_us() const {
  const Trajectory &a = sample.poses(Side::a), &b = sample.poses(Side::b);
  if (a.empty() || b.empty()) return 0;
  return std::min<std::int64_t>(a.back().time_us,
                                b.back().time_us + to_microseconds(newest->message.time_offset));
}

}  // namespace egocal::services
