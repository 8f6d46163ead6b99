// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/selection.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/uncertainty/observability.hpp"
#include "online/solve_and_verify.hpp"

namespace egocal {

namespace {

double score(const Spread& spread, int stride, const SelectionOptions& options) {
  double sum = 0;
  if (spread.rotation > 0) sum += std::log(std::max(spread.rotation, options.least_rotation));
  if (spread.translation > 0) sum += std::log(std::max(spread.translation, options.least_translation));
  const bool noise =
      spread.rotation > options.least_rotation || spread.translation > options.least_translation;
  return noise ? sum - options.longer * std::log2(stride) : sum;
}

/// parts: with blocks of at least two strides' length.
std::optional<Spread> spread_of(const Problem& parts, const SelectionOptions& options) {
  if (parts.blocks.size() < options.least_parts) return std::nullopt;
  const Matrix8d Q = cost_matrix(parts);
  const Answer answer = detail::solve_and_verify(parts, Q, Method::dual);
  const Observability known = assess_observability(parts, Q, answer.T_a_b, ErrorCorrelation::independent);
  Spread result;
  double rotation = 0, translation = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!known.observable[i] || !std::isfinite(known.stddev[i])) continue;
    ++result.directions;
    (i < 3 ? translation : rotation) += known.stddev[i] * known.stddev[i];
  }
  if (result.directions == 0) return std::nullopt;
  result.rotation = std::sqrt(rotation);
  result.translation = std::sqrt(translation);
  return result;
}

std::uint64_t two_motions(int stride) {
  return 2 * static_cast<std::uint64_t>(stride);
}

}  // namespace

std::vector<Statistics> merge_blocks(const std::vector<Statistics>& blocks, std::uint64_t least_pairs) {
  std::vector<Statistics> parts;
  parts.reserve(blocks.size());
  for (const Statistics& block : blocks) {
    if (parts.empty() || parts.back().count >= least_pairs) parts.emplace_back();
    parts.back() += block;
  }
  // a rest that is too short joins its neighbour
  if (parts.size() > 1 && parts.back().count < least_pairs) {
    const Statistics rest = parts.back();
    parts.pop_back();
    parts.back() += rest;
  }
  return parts;
}

std::vector<Statistics> independent_blocks(const std::vector<Statistics>& blocks, int stride,
                                           const SelectionOptions& options) {
  const auto steps = static_cast<std::uint64_t>(stride);
  std::vector<Statistics> long_ones = merge_blocks(blocks, 4 * steps);
  return long_ones.size() >= options.least_parts ? long_ones : merge_blocks(blocks, 2 * steps);
}

std::optional<Spread> answer_spread(const Problem& problem, int stride, const SelectionOptions& options) {
  Problem parts = problem;
  parts.blocks = merge_blocks(problem.blocks, two_motions(stride));
  return spread_of(parts, options);
}

std::optional<Selection> select_candidate(const Problem& problem, std::span<const Candidate> candidates,
                                          std::optional<std::size_t> current,
                                          const SelectionOptions& options) {
  std::optional<Selection> best;
  double best_score = 0;
  Problem trial = problem;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    trial.balance = candidates[i].balance;
    trial.blocks = merge_blocks(candidates[i].blocks, two_motions(candidates[i].stride));
    const std::optional<Spread> here = spread_of(trial, options);
    if (!here) continue;
    const double here_score =
        score(*here, candidates[i].stride, options) - (current == i ? 2 * options.hysteresis : 0);
    const bool better = !best || here->directions > best->spread.directions ||
                        (here->directions == best->spread.directions && here_score < best_score);
    if (!better) continue;
    best = Selection{i, *here};
    best_score = here_score;
  }
  return best;
}

}  // namespace egocal
