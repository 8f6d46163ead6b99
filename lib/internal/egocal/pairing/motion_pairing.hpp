// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "egocal/beside.hpp"
#include "egocal/pairing/accumulator.hpp"
#include "egocal/pairing/clock_offset.hpp"
#include "egocal/pairing/options.hpp"
#include "egocal/pairing/outcome.hpp"
#include "egocal/pairing/screening.hpp"
#include "egocal/pairing/synchroniser.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal {

/// Everything that a MotionPairing remembers: the state of each stage. Bounded whatever the length of the
/// drive. Continuing from a copy gives the same bits as never having stopped.
struct PairingState {
  std::uint64_t poses_a = 0, poses_b = 0;  ///< handed in
  Rejections rejections;                   ///< not finite; no partner while the clock was not known
  std::uint64_t segment = 0;               ///< of the clock, of the newest pose
  ClockState clock;                        ///< only where the time offset is tracked
  SynchroniserState synchroniser;
  ScreeningState screening;  ///< only where robust
  AccumulatorState accumulator;
};

/// From two streams of poses to the problem, one pose at a time. Joins the stages: clock offset (if tracked),
/// synchroniser, screening (if robust), accumulator. Used offline and by egocal-pairing alike; the result
/// depends on the poses of each stream alone, not on how the two streams interleave. Not thread-safe; one
/// object per thread.
class MotionPairing {
 public:
  /// Throws Error where an option is out of its range.
  explicit MotionPairing(PairingOptions options);
  MotionPairing(PairingOptions options, PairingState state);

  /// Takes the next pose of one stream. Returns the motion pairs of the chosen stride that it completed.
  std::vector<MotionPair> push(Side side, const StampedPose& pose);

  /// Nothing is asked before finish(): what only the answers need is left for then, which takes less time.
  void read_at_end() { settles_ = false; }

  /// The same, and push() leaves the sums over strides for add_to_sums(), which may run beside it.
  void read_at_end_beside() {
    settles_ = false;
    accumulator_.defer_sums();
  }
  std::vector<SumsStep> take_deferred() { return accumulator_.take_deferred(); }
  void add_to_sums(const std::vector<SumsStep>& steps) { accumulator_.add_to_sums(steps); }

  /// No pose comes for a while: pairs the poses that were held back while the clocks were compared. What
  /// later poses give stays the same.
  std::vector<MotionPair> release_held();
  /// Whether there are such poses.
  bool can_release() const { return options_.track_time_offset && clock_.can_release(); }

  /// No more poses will come: pairs what a drive too short to show its slower stream has held back.
  std::vector<MotionPair> finish();

  /// What is known so far.
  Problem problem() const { return current().problem(); }
  /// The same from the motions of the best single stride alone, in disjoint blocks.
  Problem single_stride_problem() const { return current().single_stride_problem(); }
  Choice choice() const { return current().choice(); }
  /// Stride of the motion pairs that push() returns.
  int stride_of_pairs() const { return accumulator_.choice().stride; }
  PairingCounts counts() const;
  /// The same, but before the first choice of motions as if none were made for an answer: costs nothing.
  PairingCounts running_counts() const { return counts_of(accumulator_); }
  /// problem() and what goes with it cost a choice, about 2 ms: it is a short drive, and no answer was asked
  /// for since the newest instant.
  bool costs_a_choice() const { return early_is_old_ && accumulator_.chooses_early(); }
  /// Instants of both streams so far, as in counts().
  std::uint64_t synchronised() const { return synchroniser_.state().synchronised; }
  const PairingOptions& options() const { return options_; }
  PairingState state() const;
  /// Time of the newest instant in the statistics [us].
  std::optional<std::int64_t> newest_us() const { return accumulator_.newest_us(); }
  /// What is added to the stamps of b [s]. Empty while it is looked for.
  std::optional<double> time_offset() const;
  /// The newest estimate, whether it is in force or not. Only where the time offset is tracked.
  const std::optional<TimeOffset>& estimated_time_offset() const { return clock_.state().newest; }

 private:
  void take(const std::vector<ReleasedPose>& released, std::vector<MotionPair>& pairs);
  void take(const std::vector<Instant>& instants, std::vector<MotionPair>& pairs);
  void settle();
  const Accumulator& current() const;
  PairingCounts counts_of(const Accumulator& accumulator) const;

  PairingOptions options_;
  std::uint64_t poses_a_ = 0, poses_b_ = 0;
  Rejections rejections_;
  std::uint64_t segment_ = 0;
  ClockFollower clock_;
  Synchroniser synchroniser_;
  Screening screening_;
  Accumulator accumulator_;
  /// The accumulator that answers for short drives, made from accumulator_ where somebody asks: a choice
  /// costs a hundred times what a pose does.
  mutable std::optional<Accumulator> early_;
  mutable bool early_is_old_ = false;
  bool settles_ = true;  ///< after every pose
};

/// Both trajectories through a MotionPairing, in the order of time.
struct PairingResult {
  MotionPairing drive;
  std::vector<MotionPair> pairs;  ///< of the stride in force when each was completed
};
PairingResult pair_motions(const PairingOptions& options, const Trajectory& a, const Trajectory& b);
/// The same without keeping the pairs, of which a long drive has many.
MotionPairing paired(const PairingOptions& options, const Trajectory& a, const Trajectory& b);
/// The same bits, half of the work beside the other half; beside may be empty.
MotionPairing paired(const PairingOptions& options, const Trajectory& a, const Trajectory& b,
                     const Beside& beside);

}  // namespace egocal
