// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "egocal/problem/blocks.hpp"
#include "egocal/robust/consensus.hpp"

namespace egocal {

/// Tuning of RobustStatistics. Study: tests/bench/outlier_study.cpp, tests/lib/test_consensus.cpp.
struct RobustOptions {
  /// Pairs that wait apart, at most; the oldest of more are summed in a block of their own kind. Bounds
  /// memory and the time of a look: 128 parts beside 64 blocks.
  std::size_t most_waiting = 128;
  /// The consensus is looked for again after this many pairs in a row that disagree, and at every doubling:
  /// four outliers in a row are rare among single wrong poses, which affect two motions each. Where they are
  /// still outliers then, the next run has to be twice as long, until the drive has grown: of a mount that
  /// turned half-way, run after run contradicts the rest (1500 looks in 20,000 poses).
  std::uint64_t suspicious_run = 4;
  /// The consensus is also looked for after this part of the pairs more (an eighth): looking stays a constant
  /// part of the work.
  std::uint64_t look_part = 8;
  ConsensusOptions consensus{};
};

/// Statistics without the motion pairs that contradict the others. A pair that disagrees with the consensus
/// of all before it waits apart (in a block of its own kind once many wait). The consensus is looked for
/// again, over all blocks and every waiting pair, when several in a row disagree (they may be the first to
/// show a new direction) and when asked to. What agrees then comes back. Bounded; nothing is discarded.
class RobustStatistics {
 public:
  /// All there is; continuing from a copy gives the same bits.
  struct State {
    BlockStatistics blocks;
    std::deque<MotionPair> waiting;
    std::optional<Agreement> agreement;
    std::uint64_t in_a_row = 0;    ///< newest pairs that all disagreed
    std::uint64_t doublings = 0;   ///< of the run after which the consensus is looked for
    std::uint64_t next_look = 16;  ///< pairs given at which the consensus is looked for again
    std::uint64_t given = 0;       ///< pairs
  };

  RobustStatistics() = default;
  explicit RobustStatistics(State state) : state_(std::move(state)) {}

  /// problem: mode, planes and balance in force. overlap: the stride, see find_consensus().
  void add(const MotionPair& pair, const Problem& problem, int overlap = 1,
           const RobustOptions& options = {});
  /// Takes in a motion that was found not to disagree, by the agreement in force.
  void add_agreeing(const detail::MotionSquare& motion);
  /// Takes in a motion whatever the others say.
  void add_unjudged(const MotionPair& pair);
  /// Looks for the consensus now.
  void look(const Problem& problem, int overlap = 1, const RobustOptions& options = {});
  /// What motions are judged by; empty while nothing is agreed on.
  const std::optional<Agreement>& agreement() const { return state_.agreement; }
  /// The newest pair contradicts the others.
  bool disagreed() const { return state_.in_a_row > 0; }
  /// The drive has grown by an eighth since the last look.
  bool look_is_due() const { return state_.given >= state_.next_look; }

  std::vector<Statistics> inliers() const { return state_.blocks.inliers(); }
  std::uint64_t inlier_pairs() const { return state_.blocks.inlier_pairs(); }
  std::uint64_t outlier_pairs() const { return state_.given - inlier_pairs(); }
  const State& state() const { return state_; }

 private:
  State state_;
};

}  // namespace egocal
