// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "egocal/estimation/jumps.hpp"
#include "egocal/estimation/stride_blocks.hpp"
#include "egocal/estimation/weighting.hpp"
#include "egocal/pairing/instant.hpp"
#include "egocal/pairing/options.hpp"

namespace egocal {

/// An instant with the verdict on the step that led to it. Motions join instants of one chain.
struct JudgedInstant {
  Instant instant;
  std::uint64_t index = 0;              ///< counted from 0
  Jump jump = Jump::none;               ///< of the step from the instant before
  std::uint64_t rotation_chain = 0;     ///< counts the jumps that spoil rotation
  std::uint64_t translation_chain = 0;  ///< counts all jumps
};

/// Tuning of StrideSums.
struct StrideSumsOptions {
  JumpOptions jumps{};
  WeightingOptions weighting{};
};

/// All that StrideSums remember; bounded. Continuing from a copy gives the same bits.
struct StrideSumsState {
  StrideBlocks committed;              ///< motions that end at instants before `first_open`
  std::deque<JudgedInstant> instants;  ///< the open ones, and before them as many as the longest motion needs
  std::uint64_t first_open = 0;        ///< index of the first instant whose verdict may change
  std::uint64_t next_index = 0;
  std::int64_t period_us = 0;         ///< typical time between instants
  std::vector<std::uint8_t> outlier;  ///< blocks left out, of outlier_length instants each
  std::uint64_t outlier_length = 1;
  std::optional<WeightChoice> choice;
  std::uint64_t jumps = 0;  ///< committed ones
};

/// Motions of many strides between instants, added up by weights that the residuals and the jack-knife choose
/// (choose_weights), without motions across jumps (find_jumps) and without blocks of instants that contradict
/// the others (find_consensus). Verdicts on the newest instants are revised as more become known. The result
/// depends on the instants alone, not on when it is asked for.
class StrideSums {
 public:
  /// Uses mode, planes, prior and accumulator options; validated() ones.
  explicit StrideSums(const PairingOptions& options, const StrideSumsOptions& tuning = {});
  StrideSums(const PairingOptions& options, const StrideSumsOptions& tuning, StrideSumsState state);

  /// Typical time between instants [us]. To be called before the first add().
  void begin(std::int64_t period_us) { state_.period_us = period_us; }
  /// Takes the next instant; chains must not decrease.
  void add(const Instant& instant);
  /// Judges the open instants anew and chooses the weights.
  void choose();

  /// Empty until a choice was made.
  const std::optional<WeightChoice>& choice() const { return state_.choice; }
  /// At the choice in force.
  Problem problem() const;
  std::uint64_t inlier_steps() const;   ///< steps between neighbouring instants that count
  std::uint64_t outlier_steps() const;  ///< that do not: jumps, and blocks that are left out
  const StrideSumsState& state() const { return state_; }

 private:
  Problem empty_problem() const;
  void append(JudgedInstant& judged, const JudgedInstant* before, Jump jump) const;
  Step step(const JudgedInstant& from, const JudgedInstant& to) const;
  void add_motions(StrideBlocks& blocks, std::size_t position) const;
  bool rejudge(const std::optional<DualQuaternion>& q);
  void commit();
  void rebuild();
  void judge_open();
  void leave_out_blocks();

  PairingOptions options_;
  StrideSumsOptions tuning_;
  DualQuaternion G_a_, G_b_;  ///< planar mode: ground frames in the sensors
  StrideSumsState state_;
  StrideBlocks sums_;  ///< committed ones and those of the open instants
};

}  // namespace egocal
