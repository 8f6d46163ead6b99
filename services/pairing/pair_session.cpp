// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/pair_session.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "egocal/bus/check.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/error.hpp"

namespace egocal::services {

namespace {
constexpr std::size_t max_early_poses = 4096;  // a limit on memory: 40 s at 100 Hz

ScaleDriveOptions scale_options(const PairingOptions& pairing, Side side) {
  ScaleDriveOptions options;
  options.pairing = pairing;
  options.scale.side = side;
  return options;
}

}  // namespace

PairSession::PairSession(const bus::Rig& rig, std::size_t index)
    : index_(index),
      config_(rig.pairs[index]),
      options_(bus::drive_options(rig, config_)),
      unscaled_(bus::unscaled_side(rig, config_)),
      drive_(options_) {
  begin_drive();
}

void PairSession::begin_drive() {
  if (unscaled_)
    scale_.emplace(scale_options(options_, *unscaled_));
  else
    drive_ = MotionPairing(options_);
}

std::vector<MotionPair> PairSession::push_pose(Side side, const StampedPose& pose) {
  return scale_ ? scale_->push(side, pose) : drive_.push(side, pose);
}

void PairSession::begin(std::int64_t time_us) {
  // receivers tell the newest problem by the largest session number
  state_.session = std::max(time_us, state_.last_session + 1);
  EGOCAL_CHECK(state_.session > state_.last_session, "session numbers only grow");
  state_.last_session = state_.session;
  begin_drive();
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
                              pairing().synchronised() == 0 && state_.early.size() < max_early_poses;
  if (!second_of_both) {
    state_.session = -1;
    state_.restarted_by = side;
    return;
  }
  // the other stream started again shortly before: the session stays, without the poses that this stream
  // still sent on the old timeline
  begin_drive();
  std::erase_if(state_.early, [side](const EarlyPose& early) { return early.side == side; });
  for (const EarlyPose& early : state_.early) push_pose(early.side, early.pose);
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
    if (pairing().synchronised() > 0) {
      state_.restarted_by.reset();
      state_.early = {};
    } else if (state_.early.size() < max_early_poses) {
      state_.early.push_back({side, pose});
    }
  }
  const std::uint64_t solved = scale_ ? scale_->solved_motions() : 0;
  hand_out(push_pose(side, pose), out);
  if (scale_ && scale_->solved_motions() != solved) fresh_ = true;
}

void PairSession::release_held(std::vector<MotionOut>& out) {
  if (!can_release()) return;
  received_mono_us_ = 0;  // they came before the silence, which is no latency of a solver
  const std::uint64_t solved = scale_ ? scale_->solved_motions() : 0;
  hand_out(scale_ ? scale_->release_held() : drive_.release_held(), out);
  if (scale_ && scale_->solved_motions() != solved) fresh_ = true;
}

std::string PairSession::without_clock() const {
  if (state_.session < 0 || paused() || pairing().time_offset()) return "";
  const std::string text = config_.a + " -> " + config_.b + ": no motion yet, as time_offset = \"auto\" ";
  if (pairing().estimated_time_offset())
    return text + "finds no offset of the clocks that it trusts: the sensors hardly turn, or not together";
  const double seconds = options_.clock.first + options_.clock.delay;  // a slow stream takes longer
  return text + "compares the clocks after " + std::to_string(std::llround(seconds)) +
         " s or more of both streams; a shorter drive: egocal solve --time-offset auto";
}

void PairSession::hand_out(const std::vector<MotionPair>& pairs, std::vector<MotionOut>& out) {
  for (const MotionPair& pair : pairs) {
    ++state_.seq;
    if (!scale_) fresh_ = true;
    if (scale_ && !scale_->known()) continue;  // motions of unknown length are of no use to listeners
    motion_pair_t& message = out.emplace_back(MotionOut{index_, bus::to_message(pair)}).message;
    message.session = state_.session;
    message.seq = state_.seq;
    message.stride = scale_ ? scale_->choice().stride : drive_.stride_of_pairs();
  }
}

std::optional<problem_t> PairSession::message() {
  if (!has_problem()) return std::nullopt;
  if (scale_ && !scale_->known()) {
    fresh_ = false;
    return std::nullopt;
  }
  problem_t message = bus::to_message(scale_ ? *scale_->problem() : drive_.problem());
  message.utime = pairing().newest_us().value_or(state_.session);
  message.session = state_.session;
  message.seq = state_.seq;
  if (scale_) {  // of the newest solution
    message.utime = scale_->solved_us();
    message.seq = static_cast<std::int64_t>(scale_->solved_motions());
  }
  message.sensor_a = config_.a;
  message.sensor_b = config_.b;
  const Choice choice = scale_ ? scale_->choice() : drive_.choice();
  message.stride = choice.stride;
  message.choice = choice.reason;
  if (config_.truth) {
    message.has_truth = 1;
    bus::set_pose(to_dual_quaternion(*config_.truth), message.truth_pos, message.truth_quat);
  }
  message.time_offset = pairing().time_offset().value_or(0);
  message.time_offset_stddev = -1;
  if (const std::optional<TimeOffset>& estimate = pairing().estimated_time_offset())
    message.time_offset_stddev = estimate->stddev;
  const PairingCounts counts = this->counts();
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

std::optional<scale_problem_t> PairSession::scale_message() const {
  if (state_.session < 0 || !scale_ || !scale_->scale_problem()) return std::nullopt;
  scale_problem_t message = bus::to_message(*scale_->scale_problem());
  message.utime = scale_->solved_us();
  message.session = state_.session;
  message.seq = static_cast<std::int64_t>(scale_->solved_motions());
  message.sensor_a = config_.a;
  message.sensor_b = config_.b;
  message.scale = scale_->known() ? scale_->solution().scale : 0;
  return message;
}

void PairSession::count(std::map<std::string, std::int64_t>& counters) const {
  const PairingCounts counts = scale_ ? scale_->counts() : drive_.running_counts();
  counters["matched"] += static_cast<std::int64_t>(counts.matched);
  counters["outliers"] += static_cast<std::int64_t>(counts.outliers);
  for (std::size_t i = 0; i < counts.rejected.size(); ++i)
    if (counts.rejected[i] > 0)
      counters["rejected: " + std::string(to_string(static_cast<Rejection>(i)))] +=
          static_cast<std::int64_t>(counts.rejected[i]);
}

PairState PairSession::state() const {
  PairState state = state_;
  if (scale_)
    state.scale = scale_->state();
  else
    state.drive = drive_.state();
  return state;
}

void PairSession::restore(PairState state) {
  if (state.scale.has_value() != unscaled_.has_value()) throw Error("is of a rig with another scale");
  if (unscaled_)
    scale_.emplace(scale_options(options_, *unscaled_), std::move(*std::exchange(state.scale, std::nullopt)));
  else
    drive_ = MotionPairing(options_, std::exchange(state.drive, {}));
  state_ = std::move(state);
  fresh_ = false;
}

}  // namespace egocal::services
