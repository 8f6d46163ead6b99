// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "egocal/estimation/attenuation.hpp"
#include "egocal/motions/instant.hpp"
#include "egocal/pairing/options.hpp"
#include "egocal/pairing/outcome.hpp"
#include "egocal/pairing/selection.hpp"
#include "egocal/pairing/stride_sums.hpp"
#include "egocal/problem/problem.hpp"
#include "egocal/robust/robust_statistics.hpp"

namespace egocal {

/// Tuning of what an Accumulator is made of.
struct EstimationOptions {
  RobustOptions robust{};
  SelectionOptions selection{};
  StrideSumsOptions sums{};
  /// Stride and balance are chosen again after this part of the drive more (a quarter): choosing stays a
  /// constant part of the work.
  std::uint64_t choice_part = 4;
};

/// All that an Accumulator remembers. Bounded; continuing from a copy gives the same bits.
struct AccumulatorState {
  struct PerStride {
    int stride = 1;
    RobustStatistics statistics;
  };

  Choice choice;
  std::int64_t period_us = 0;              ///< typical time between instants
  std::deque<Instant> instants;            ///< the newest, as many as the longest motion needs
  std::vector<PerStride> strides;          ///< under consideration
  std::uint64_t next_choice = 0;           ///< number of the instant at which to choose again
  std::optional<StrideSumsState> sums;     ///< where neither stride nor balance is given, and robust
  std::optional<Attenuation> attenuation;  ///< in force, by the last choice
  Rejections rejections;                   ///< gap, too much rotation; of motions of the chosen stride
};

/// A step that the sums over strides have not taken yet: an instant, or a new beginning.
struct SumsStep {
  enum class Kind { instant, begin, restart };

  Kind kind = Kind::instant;
  Instant instant;
  std::int64_t period_us = 0;  ///< of a new beginning
  bool doubtful = false;
  bool choose = false;  ///< the weights, after the instant
  /// The best single stride, where weights or stride were chosen, which is rare.
  std::shared_ptr<const SingleStride> single;
};

/// Instants in, statistics of every stride under consideration and the choice among them out.
class Accumulator {
 public:
  /// Uses mode, planes, stride, balance, robust, prior and the options of its own stage; validated() ones.
  explicit Accumulator(const PairingOptions& options, const EstimationOptions& tuning = {});
  Accumulator(const PairingOptions& options, AccumulatorState state, const EstimationOptions& tuning = {});

  /// Typical time between instants [us]. To be called before the first add().
  void begin(std::int64_t period_us);
  /// Takes the next instant; chains must not decrease. Returns the motion pairs of the chosen stride that it
  /// completed.
  std::vector<MotionPair> add(const Instant& instant);
  /// Does what only problem() and state() need, so that these are fast (StrideSums::settle).
  void settle();
  /// Forgets all instants and statistics, but not the choice.
  void restart();

  /// From now on add() leaves the sums over strides for add_to_sums(), which may run beside it: they say
  /// nothing to the rest before the answer is asked for, and are half of the work. To be called before the
  /// first add().
  void defer_sums();
  /// The steps that add() has left since the last call.
  std::vector<SumsStep> take_deferred() { return std::exchange(deferred_, {}); }
  /// Adds all deferred steps in order, before anything else is asked: the same bits as without defer_sums().
  void add_to_sums(const std::vector<SumsStep>& steps);

  /// What would be known if a choice were made now: before the first choice, but from
  /// AccumulatorOptions::early_choice on. Empty at other times. This accumulator goes on without that choice,
  /// so that no later answer depends on when it was asked.
  std::optional<Accumulator> with_early_choice() const;
  /// Whether with_early_choice() would return one.
  bool chooses_early() const;

  /// What is known so far, at the choice in force.
  Problem problem() const;
  /// The same from the motions of the best single stride alone, in disjoint blocks.
  Problem single_stride_problem() const;
  Choice choice() const;
  std::uint64_t inlier_pairs() const;   ///< in the statistics of the chosen stride
  std::uint64_t outlier_pairs() const;  ///< of the chosen stride, that contradict the others; may come back
  std::uint64_t jumps() const;  ///< steps across which an odometry jumps; 0 where it is not looked for
  std::optional<std::int64_t> newest_us() const;  ///< time of the newest instant
  bool begun() const { return state_.period_us != 0; }
  const Rejections& rejections() const { return state_.rejections; }
  AccumulatorState state() const;

 private:
  Problem empty_problem() const;
  Problem plain_problem() const;
  const AccumulatorState::PerStride* chosen() const;
  std::vector<MotionPair> add_motions(const Instant& instant, const Problem& problem, bool& doubtful);
  bool joined(const Instant& from, const Instant& to, int stride, Rejections& rejections) const;
  std::optional<MotionPair> motion(const Instant& from, const Instant& to, int stride,
                                   Rejections& rejections);
  std::uint64_t choice_delay() const;
  void choose();
  void choose_all();
  void defer(const Instant& instant, bool doubtful, bool chosen_anew);

  PairingOptions options_;
  EstimationOptions tuning_;
  double least_scalar_;       ///< of a rotation that is not too large: cosine of half its angle
  DualQuaternion G_a_, G_b_;  ///< planar mode: ground frames in the sensors
  AccumulatorState state_;    ///< except for the sums
  std::optional<StrideSums> sums_;
  bool defers_ = false;
  std::vector<SumsStep> deferred_;
  std::uint64_t deferred_instants_ = 0, deferred_choice_ = 0;  ///< StrideSumsState's, after the deferred ones
};

}  // namespace egocal
