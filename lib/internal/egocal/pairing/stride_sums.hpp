// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "egocal/estimation/jumps.hpp"
#include "egocal/estimation/stride_blocks.hpp"
#include "egocal/estimation/weighted_blocks.hpp"
#include "egocal/estimation/weighting.hpp"
#include "egocal/motions/instant.hpp"
#include "egocal/pairing/options.hpp"
#include "egocal/robust/consensus.hpp"

namespace egocal {

/// An instant with the verdict on the step that led to it. Motions join instants of one chain.
struct JudgedInstant {
  Instant instant;
  std::uint64_t index = 0;              ///< counted from 0
  Jump jump = Jump::none;               ///< of the step from the instant before
  std::uint64_t rotation_chain = 0;     ///< counts the jumps of rotation
  std::uint64_t translation_chain = 0;  ///< counts all jumps
  bool doubtful = false;                ///< no motion begins or ends here
  double step_variance = 0;             ///< of the step from the instant before, beyond what is typical
  double total_variance = 0;            ///< the sum of these over all steps; in typical variances of a step
};

/// Tuning of StrideSums.
struct StrideSumsOptions {
  JumpOptions jumps{};
  WeightingOptions weighting{};
  ConsensusOptions consensus{};
  /// Strides of the motions [steps]: each about 1.4 times the one before. The longest bounds the memory;
  /// motions of 128 steps are longer than the memory of any odometry on record (docs/accuracy.md).
  std::vector<int> strides{1, 2, 3, 4, 6, 8, 11, 16, 23, 32, 45, 64, 90, 128};
  /// Instants whose verdicts may still change: enough for quartiles, few enough for a look in 0.1 ms.
  std::uint64_t most_open = 192;
  /// The open instants are judged again after this part more (one sixteenth), within these limits: a jump
  /// spoils every motion across it, and short drives have few to spare.
  std::uint64_t look_part = 16, least_look = 16, most_look = 64;
  /// The weights are chosen again after an eighth more instants, and after a quarter more beyond
  /// `short_drive`: a choice costs as much as a hundred instants (docs/benchmarks.md).
  std::uint64_t short_choice_part = 8, choice_part = 4, short_drive = 128;
  /// Rounds of verdicts and weights that depend on each other: bounds the time of a choice.
  int most_rounds = 3;
  /// A variance below this is what rounding leaves of a difference of sums [typical variances]: the sums of a
  /// million steps with variances up to 1e4 are rounded by 1e-6.
  double least_extra_variance = 1e-6;
  /// Variances of a step that change its weight by less than this part are not summed again.
  double least_change = 0.1;
};

/// All that StrideSums remember; bounded. Continuing from a copy gives the same bits.
struct StrideSumsState {
  StrideBlocks committed;              ///< motions that end at instants before `first_open`
  std::deque<JudgedInstant> instants;  ///< the open ones, and before them as many as the longest motion needs
  std::uint64_t first_open = 0;        ///< index of the first instant whose verdict may change
  std::uint64_t next_index = 0;
  std::uint64_t next_look = 0;        ///< number of instants at which the open ones are judged again
  std::uint64_t next_choice = 0;      ///< number of instants at which the next choice is due
  std::int64_t period_us = 0;         ///< typical time between instants
  std::vector<std::uint8_t> outlier;  ///< blocks omitted, of outlier_length instants each
  std::uint64_t outlier_length = 1;
  std::optional<WeightChoice> choice;
  WeightedBlocks weighted;  ///< all motions, by the choice; while it is in force
  std::uint64_t jumps = 0;  ///< committed ones
};

/// Motions of many strides between instants, added up by weights that the residuals and the jack-knife choose
/// (choose_weights), without motions across jumps (find_jumps) and without blocks of instants that contradict
/// the others (find_consensus). Verdicts on the newest instants are revised as more become known. The result
/// depends on the instants alone.
class StrideSums {
 public:
  /// Uses mode, planes, prior and accumulator options; validated() ones.
  explicit StrideSums(const PairingOptions& options, const StrideSumsOptions& tuning = {});
  StrideSums(const PairingOptions& options, const StrideSumsOptions& tuning, StrideSumsState state);

  /// Typical time between instants [us]. To be called before the first add().
  void begin(std::int64_t period_us) { state_.period_us = period_us; }
  /// Takes the next instant; chains must not decrease. doubtful: its motion contradicts the others, as judged
  /// outside; it is not used.
  void add(const Instant& instant, bool doubtful = false);
  /// Does what only fill() and state() need, so that these are fast: to be called before they are, or once
  /// at the end of a drive. Left for later it costs less, and the result is the same to the last bit.
  void settle();
  /// The drive has grown by an eighth since the last choice.
  bool choice_is_due() const;
  /// Judges the open instants again and chooses the weights. rival: the best single stride.
  void choose(const std::optional<SingleStride>& rival = {});

  /// The newest choice; empty until one was made.
  const std::optional<WeightChoice>& choice() const { return state_.choice; }
  /// Whether a choice was made and its spread is clearly smaller than the rival's.
  bool in_force() const { return state_.choice && state_.choice->beats_single; }
  /// Sets blocks and balance of a problem, at the choice in force.
  void fill(Problem& problem) const;
  /// Steps between neighbouring instants across which an odometry jumps: no motion spans them.
  std::uint64_t jumps() const;
  StrideSumsState state() const;

 private:
  Problem empty_problem() const;
  void append(JudgedInstant& judged, const JudgedInstant* before, const StepVerdict& verdict) const;
  bool too_long(const JudgedInstant& from, const JudgedInstant& to) const;
  Step step(const JudgedInstant& from, const JudgedInstant& to) const;
  double certainty(const JudgedInstant& from, const JudgedInstant& to) const;
  void add_motions(std::uint64_t index, StrideBlocks* sums, WeightedBlocks* weighted) const;
  void weigh_pending(WeightedBlocks& weighted) const;
  bool all_is_valid() const;
  void complete_all();
  StrideBlocks& sums();
  void weigh_all(const TouchingSums& sums);
  void commit_oldest();
  struct Changes {
    bool jumps = false, variances = false;
    bool any = false;  ///< to the last bit
  };
  void measure_steps(std::size_t first);
  Changes rejudge(const std::optional<DualQuaternion>& q);
  StrideBlocks& judge_open();
  void leave_out_blocks(StrideBlocks& all);

  PairingOptions options_;
  StrideSumsOptions tuning_;
  double least_scalar_;       ///< of a rotation that is not too large: cosine of half its angle
  DualQuaternion G_a_, G_b_;  ///< planar mode: ground frames in the sensors
  StrideSumsState state_;
  /// Index of the first instant whose motions are not in state_.weighted yet; all later ones are not either.
  std::uint64_t first_pending_ = 0;
  /// Sums over all motions that end before the instant with index all_until_, including those of the open
  /// instants; stale where the open instants were judged anew since. Not part of the state: made again, the
  /// sums have the same bits.
  StrideBlocks all_;
  std::uint64_t all_until_ = 0;
  bool all_stale_ = true;
  /// Steps to the instants from index measured_from_ on. Not part of the state either.
  std::vector<MeasuredStep> measured_;
  std::uint64_t measured_from_ = 0;
};

}  // namespace egocal
