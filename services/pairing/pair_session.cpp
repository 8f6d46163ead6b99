// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/pair_session.hpp"

#include <algorithm>

#include "egocal/bus/check.hpp"
#include "egocal/bus/convert.hpp"

namespace egocal::services {

namespace {
constexpr std::size_t max_early_poses = 4096;

/// The pairs of a rig estimate their clocks one after the other.
PairingOptions options_of(const bus::Rig& rig, std::size_t index) {
  PairingOptions options = bus::drive_options(rig, rig.pairs[index]);
  options.clock.phase = static_cast<double>(index) / static_cast<double>(rig.pairs.size());
  return options;
}

}  // namespace

PairSession::PairSession(const bus::Rig& rig, std::size_t index)
    : index_(index), config_(rig.pairs[index]), options_(options_of(rig, index)), drive_(options_) {}

void PairSession::begin(std::int64_t time_us) {
  // session numbers only grow, so that the newest problem is known by it
  state_.session = std::max(time_us, state_.last_session + 1);
  EGOCAL_CHECK(state_.session > state_.last_session, "session numbers only grow");
  state_.last_session = state_.session;
  drive_ = MotionPairing(options_);
  state_.seq = 0;
  state_.early.clear();
  fresh_ = false;
}

void PairSession::reset() {
  state_.session = -1;
  state_.restarted_by.reset();
}

void PairSession::timeline_restarts(Side side) {
  const bool second_of_both = state_.session >= 0 && state_.restarted_by && *state_.restarted_by != side &&
                              drive_.counts().synchronised == 0 && state_.early.size() < max_early_poses;
  if (!second_of_both) {
    state_.session = -1;
    state_.restarted_by = side;
    return;
  }
  // the other stream began anew shortly before: same session, without what this one still sent of the old
  // timeline
  drive_ = MotionPairing(options_);
  std::erase_if(state_.early, [side](const EarlyPose& early) { return early.side == side; });
  for (const EarlyPose& early : state_.early) drive_.push(early.side, early.pose);
  state_.restarted_by.reset();
}

void PairSession::push(Side side, const NumberedPose& sample, std::vector<MotionOut>& out) {
  if (sample.begins_anew) timeline_restarts(side);
  if (state_.paused) return;
  if (state_.session < 0) begin(sample.pose.time_us);
  received_mono_us_ = sample.mono_us;
  accumulate(side, sample.pose, out);
}

void PairSession::accumulate(Side side, const StampedPose& pose, std::vector<MotionOut>& out) {
  if (state_.restarted_by) {
    if (drive_.counts().synchronised > 0) {
      state_.restarted_by.reset();
      state_.early = {};
    } else if (state_.early.size() < max_early_poses) {
      state_.early.push_back({side, pose});
    }
  }
  for (const MotionPair& pair : drive_.push(side, pose)) {
    motion_pair_t& message = out.emplace_back(MotionOut{index_, bus::to_message(pair)}).message;
    message.session = state_.session;
    message.seq = ++state_.seq;
    message.stride = drive_.choice().stride;
    fresh_ = true;
  }
}

std::optional<problem_t> PairSession::message() {
  if (state_.session < 0 || state_.seq == 0) return std::nullopt;
  problem_t message = bus::to_message(drive_.problem());
  message.utime = drive_.newest_us().value_or(state_.session);
  message.session = state_.session;
  message.seq = state_.seq;
  message.sensor_a = config_.a;
  message.sensor_b = config_.b;
  message.stride = drive_.choice().stride;
  message.choice = drive_.choice().reason;
  if (config_.truth) {
    message.has_truth = 1;
    bus::set_pose(to_dual_quaternion(*config_.truth), message.truth_pos, message.truth_quat);
  }
  message.time_offset = drive_.time_offset().value_or(0);
  message.time_offset_stddev = -1;
  if (const std::optional<TimeOffset>& estimate = drive_.estimated_time_offset())
    message.time_offset_stddev = estimate->stddev;
  const PairingCounts counts = drive_.counts();
  message.matched = static_cast<std::int64_t>(counts.matched);
  message.left_out = static_cast<std::int64_t>(counts.outliers);
  for (const std::uint64_t rejected : counts.rejected)
    message.rejected += static_cast<std::int64_t>(rejected);
  EGOCAL_CHECK(message.matched >= 0 && message.left_out >= 0 && message.rejected >= 0,
               "no count of motion pairs is negative");
  message.received_mono_us = fresh_ ? received_mono_us_ : 0;
  fresh_ = false;
  return message;
}

void PairSession::count(std::map<std::string, std::int64_t>& counters) const {
  const PairingCounts counts = drive_.counts();
  counters["matched"] += static_cast<std::int64_t>(counts.matched);
  counters["outliers"] += static_cast<std::int64_t>(counts.outliers);
  for (std::size_t i = 0; i < counts.rejected.size(); ++i)
    if (counts.rejected[i] > 0)
      counters["rejected: " + std::string(to_string(static_cast<Rejection>(i)))] +=
          static_cast<std::int64_t>(counts.rejected[i]);
}

PairState PairSession::state() const {
  PairState state = state_;
  state.drive = drive_.state();
  return state;
}

void PairSession::restore(PairState state) {
  drive_ = MotionPairing(options_, std::exchange(state.drive, {}));
  state_ = std::move(state);
  fresh_ = false;
}

}  // namespace egocal::services
