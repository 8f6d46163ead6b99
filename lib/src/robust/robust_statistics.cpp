// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/robust/robust_statistics.hpp"

#include <algorithm>
#include <bit>

#include "robust/residual_limit.hpp"

namespace egocal {

namespace {

constexpr std::uint64_t most_doublings = 32;  // of a run: longer than any drive

Statistics of_one(const MotionPair& pair) {
  Statistics statistics;
  statistics.add(pair);
  return statistics;
}

}  // namespace

void RobustStatistics::add_unjudged(const MotionPair& pair) {
  ++state_.given;
  state_.blocks.add(pair);
}

void RobustStatistics::add_agreeing(const detail::MotionSquare& motion) {
  ++state_.given;
  state_.blocks.add(motion);
  state_.in_a_row = 0;
}

void RobustStatistics::add(const MotionPair& pair, const Problem& problem, int overlap,
                           const RobustOptions& options) {
  ++state_.given;
  const bool disagrees = state_.agreement && detail::disagreement(pair.a, pair.b, problem.balance,
                                                                  *state_.agreement, options.consensus) > 1;
  if (disagrees) {
    state_.waiting.push_back(pair);
    if (state_.waiting.size() > options.most_waiting) {
      state_.blocks.add(state_.waiting.front(), true);
      state_.waiting.pop_front();
    }
    ++state_.in_a_row;
  } else {
    state_.blocks.add(pair);
    state_.in_a_row = 0;
  }
  if (state_.in_a_row < options.suspicious_run << state_.doublings || !std::has_single_bit(state_.in_a_row))
    return;
  const std::uint64_t doublings = state_.doublings;
  look(problem, overlap, options);
  const bool came_back = state_.waiting.empty() || state_.waiting.back().end_us != pair.end_us;
  state_.doublings = came_back ? 0 : std::min<std::uint64_t>(doublings + 1, most_doublings);
}

void RobustStatistics::look(const Problem& problem, int overlap, const RobustOptions& options) {
  if (state_.doublings > 0) --state_.doublings;
  state_.next_look = state_.given + std::max<std::uint64_t>(1, state_.given / options.look_part);
  const auto& blocks = state_.blocks.state().blocks;
  std::vector<Statistics> parts;
  parts.reserve(blocks.size() + state_.waiting.size());
  for (const BlockStatistics::Block& block : blocks) parts.push_back(block.statistics);
  for (const MotionPair& pair : state_.waiting) parts.push_back(of_one(pair));
  const std::optional<Consensus> consensus = find_consensus(problem, parts, overlap, options.consensus);
  if (!consensus) return;  // what was agreed on before stays in force
  const std::vector<bool>& outlier = consensus->outlier;
  state_.agreement = consensus->agreement;
  const auto first_waiting = outlier.begin() + static_cast<std::ptrdiff_t>(blocks.size());
  state_.blocks.leave_out({outlier.begin(), first_waiting});
  std::deque<MotionPair> waiting;
  for (std::size_t i = 0; i < state_.waiting.size(); ++i) {
    if (first_waiting[static_cast<std::ptrdiff_t>(i)])
      waiting.push_back(state_.waiting[i]);
    else
      state_.blocks.add(state_.waiting[i]);
  }
  state_.waiting = std::move(waiting);
}

}  // namespace egocal
