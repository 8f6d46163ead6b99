// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/motion_pairing.hpp"

#include <utility>

#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "pairing/single_stride_choice.hpp"

namespace egocal {

namespace {

/// Whether the pose is finite, within egocal::limits, and its rotation near unit length.
bool plausible(const StampedPose& pose) {
  return pose.pose.real.allFinite() && pose.pose.dual.allFinite() && plausible_norm(pose.pose.real.norm()) &&
         plausible_relative_time(pose.time_us) && plausible_distance(translation_length(pose.pose));
}

}  // namespace

MotionPairing::MotionPairing(PairingOptions options)
    : options_(validated(std::move(options))),
      clock_(options_),
      synchroniser_(options_),
      screening_(options_.screening),
      accumulator_(options_) {}

MotionPairing::MotionPairing(PairingOptions options, PairingState state)
    : options_(validated(std::move(options))),
      poses_a_(state.poses_a),
      poses_b_(state.poses_b),
      rejections_(state.rejections),
      segment_(state.segment),
      clock_(options_, std::move(state.clock)),
      synchroniser_(options_, std::move(state.synchroniser)),
      screening_(options_.screening, std::move(state.screening)),
      accumulator_(options_, std::move(state.accumulator)),
      early_is_old_(true) {}

std::vector<MotionPair> MotionPairing::push(Side side, const StampedPose& given) {
  ++(side == Side::a ? poses_a_ : poses_b_);
  if (!plausible(given)) {
    rejections_.add(Rejection::not_finite);
    return {};
  }
  StampedPose pose = given;
  pose.pose = normalized(pose.pose);
  std::vector<MotionPair> pairs;
  if (!options_.track_time_offset) {
    if (side == Side::b) pose.time_us += to_microseconds(options_.time_offset);
    take(synchroniser_.push(side, pose), pairs);
    if (settles_) settle();
    return pairs;
  }
  const std::uint64_t given_up = clock_.state().given_up;
  const std::vector<ReleasedPose> released = clock_.push(side, pose);
  rejections_.add(Rejection::no_partner, clock_.state().given_up - given_up);
  take(released, pairs);
  if (settles_) settle();
  return pairs;
}

std::vector<MotionPair> MotionPairing::release_held() {
  std::vector<MotionPair> pairs;
  if (!can_release()) return pairs;
  take(clock_.release_held(), pairs);
  if (settles_) settle();
  return pairs;
}

std::vector<MotionPair> MotionPairing::finish() {
  std::vector<MotionPair> pairs;
  if (options_.track_time_offset) take(clock_.finish(), pairs);
  take(synchroniser_.finish(), pairs);
  screening_.finish();
  accumulator_.add_to_sums(accumulator_.take_deferred());
  settle();
  return pairs;
}

/// Settles the accumulator; called before answers are asked for.
void MotionPairing::settle() {
  accumulator_.settle();
  early_is_old_ = !early_ || early_->newest_us() != accumulator_.newest_us();
}

const Accumulator& MotionPairing::current() const {
  if (std::exchange(early_is_old_, false)) early_ = accumulator_.with_early_choice();
  return early_ ? *early_ : accumulator_;
}

void MotionPairing::take(const std::vector<ReleasedPose>& released, std::vector<MotionPair>& pairs) {
  for (const ReleasedPose& one : released) {
    // no motion spans a change of the clock
    if (one.segment != segment_) take(synchroniser_.begin_chain(), pairs);
    segment_ = one.segment;
    take(synchroniser_.push(one.side, one.pose), pairs);
  }
}

void MotionPairing::take(const std::vector<Instant>& instants, std::vector<MotionPair>& pairs) {
  const std::int64_t period_us = synchroniser_.period_us();
  if (!instants.empty() && !accumulator_.begun()) accumulator_.begin(period_us);
  for (const Instant& instant : instants) {
    Screened screened;
    if (options_.robust)
      screened = screening_.push(instant, period_us);
    else
      screened.accepted = {instant};
    if (screened.replaces) accumulator_.restart();
    for (const Instant& accepted : screened.accepted) {
      std::vector<MotionPair> more = accumulator_.add(accepted);
      // pairs of instants that are screened a second time were handed out before
      if (screened.replaces && accepted.time_us != instant.time_us) continue;
      if (pairs.empty())
        pairs = std::move(more);
      else
        pairs.insert(pairs.end(), more.begin(), more.end());
    }
  }
}

PairingCounts MotionPairing::counts() const {
  return counts_of(current());
}

PairingCounts MotionPairing::counts_of(const Accumulator& accumulator) const {
  PairingCounts counts;
  counts.poses_a = poses_a_;
  counts.poses_b = poses_b_;
  counts.synchronised = synchronised();
  counts.matched = accumulator.inlier_pairs();
  counts.outliers = accumulator.outlier_pairs();
  counts.jumps = accumulator.jumps();
  for (const Rejections* stage : {&rejections_, &synchroniser_.state().rejections,
                                  &screening_.state().rejections, &accumulator_.rejections()})
    for (std::size_t i = 0; i < counts.rejected.size(); ++i) counts.rejected[i] += stage->by_reason[i];
  return counts;
}

PairingState MotionPairing::state() const {
  return {poses_a_,           poses_b_,
          rejections_,        segment_,
          clock_.state(),     synchroniser_.state(),
          screening_.state(), accumulator_.state()};
}

std::optional<double> MotionPairing::time_offset() const {
  return options_.track_time_offset ? clock_.seconds() : options_.time_offset;
}

namespace {

/// The poses of both streams in the order of time.
class InOrder {
 public:
  InOrder(const Trajectory& a, const Trajectory& b) : a_(a), b_(b) {}

  bool more() const { return i_ < a_.size() || j_ < b_.size(); }
  std::vector<MotionPair> push_next(MotionPairing& drive) {
    const bool from_a = j_ == b_.size() || (i_ < a_.size() && a_[i_].time_us <= b_[j_].time_us);
    return from_a ? drive.push(Side::a, a_[i_++]) : drive.push(Side::b, b_[j_++]);
  }

 private:
  const Trajectory &a_, &b_;
  std::size_t i_ = 0, j_ = 0;
};

}  // namespace

PairingResult pair_motions(const PairingOptions& options, const Trajectory& a, const Trajectory& b) {
  std::vector<MotionPair> pairs;
  const auto take = [&pairs](const std::vector<MotionPair>& more) {
    pairs.insert(pairs.end(), more.begin(), more.end());
  };
  MotionPairing drive(options);
  drive.read_at_end();
  for (InOrder poses(a, b); poses.more();) take(poses.push_next(drive));
  take(drive.finish());
  return {std::move(drive), std::move(pairs)};
}

Choice detail::single_stride_choice(const PairingOptions& options, const Trajectory& a, const Trajectory& b) {
  PairingState state = MotionPairing(options).state();
  state.accumulator.sums.reset();
  MotionPairing drive(options, std::move(state));
  drive.read_at_end();
  for (InOrder poses(a, b); poses.more();) poses.push_next(drive);
  drive.finish();
  return drive.choice();
}

MotionPairing paired(const PairingOptions& options, const Trajectory& a, const Trajectory& b) {
  MotionPairing drive(options);
  drive.read_at_end();
  for (InOrder poses(a, b); poses.more();) poses.push_next(drive);
  drive.finish();
  return drive;
}

MotionPairing paired(const PairingOptions& options, const Trajectory& a, const Trajectory& b,
                     const Beside& beside) {
  if (!beside) return paired(options, a, b);
  constexpr int at_once = 8192;  // poses: ten milliseconds, beside which a thread costs little
  MotionPairing drive(options);
  drive.read_at_end_beside();
  std::vector<SumsStep> deferred;
  for (InOrder poses(a, b); poses.more();) {
    const auto push_some = [&] {
      for (int i = 0; i < at_once && poses.more(); ++i) poses.push_next(drive);
    };
    beside(push_some, [&] { drive.add_to_sums(deferred); });
    deferred = drive.take_deferred();
  }
  drive.add_to_sums(deferred);
  drive.finish();
  return drive;
}

}  // namespace egocal
