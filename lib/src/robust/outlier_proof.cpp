// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/robust/prove_outliers.hpp"

#include <algorithm>
#include <cmath>

#include "robust/choice_search.hpp"
#include "robust/leverage.hpp"
#include "robust/residual_limit.hpp"

namespace egocal {

namespace {

using namespace detail;

/// Whether the choice agrees with its own limits: every kept part is below its limit, every outlier above.
bool settled(const LeverageBound& bound, const std::vector<bool>& outlier) {
  for (std::size_t k = 0; k < outlier.size(); ++k) {
    const bool above = bound.parts[k].cost > bound.parts[k].limit;
    if (above != outlier[k]) return false;
  }
  return true;
}

}  // namespace

std::string_view to_string(OutlierChoice choice) {
  switch (choice) {
    case OutlierChoice::proven:
      return "proven";
    case OutlierChoice::not_proven:
      return "not proven";
    case OutlierChoice::not_best:
      return "not the best";
  }
  return "unknown";
}

OutlierProof prove_outliers(std::span<const TruncatedPart> parts, const std::vector<bool>& outlier,
                            const OutlierProofOptions& options) {
  OutlierProof proof;
  proof.undecided = parts.size();
  const std::optional<LeverageBound> bound = leverage_bound(parts, outlier);
  if (!bound) return proof;
  proof.cost = bound->cost;
  if (!settled(*bound, outlier)) return proof;
  const std::vector<std::size_t> undecided = undecided_parts(*bound, outlier, options.distance_step);
  proof.undecided = undecided.size();
  if (undecided.empty()) {
    proof.choice = OutlierChoice::proven;
    return proof;
  }
  const ChoiceSearch found = search_choices(parts, outlier, undecided, bound->cost, options);
  proof.solves = found.solves;
  if (found.better) {
    proof.choice = OutlierChoice::not_best;
    proof.better = *found.better;
  } else if (found.complete) {
    proof.choice = OutlierChoice::proven;
  }
  return proof;
}

std::optional<OutlierProof> prove_outliers(const Problem& problem, std::span<const Statistics> parts,
                                           const std::vector<bool>& outlier, int overlap,
                                           const OutlierProofOptions& options) {
  if (problem.mode == Mode::planar || parts.size() != outlier.size()) return std::nullopt;
  const std::optional<Consensus> consensus = find_consensus(problem, parts, overlap, options.consensus);
  if (!consensus) return std::nullopt;
  std::vector<TruncatedPart> truncated;
  for (const Statistics& part : parts)
    truncated.push_back(
        {part.weight * cost_matrix(part, problem.balance),
         part.weight * residual_limit(part, problem.balance, consensus->agreement.scale, options.consensus)});
  return prove_outliers(truncated, outlier, options);
}

std::optional<OutlierProof> prove_outliers(const Problem& problem, const RobustStatistics& statistics,
                                           int overlap, const OutlierProofOptions& options) {
  std::vector<Statistics> parts;
  std::vector<bool> outlier;
  for (const BlockStatistics::Block& block : statistics.state().blocks.state().blocks) {
    parts.push_back(block.statistics);
    outlier.push_back(block.outlier);
  }
  for (const MotionPair& pair : statistics.state().waiting) {
    parts.emplace_back().add(pair);
    outlier.push_back(true);
  }
  return prove_outliers(problem, parts, outlier, overlap, options);
}

}  // namespace egocal
