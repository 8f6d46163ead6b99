// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/robust/outlier_proof.hpp"

#include <algorithm>
#include <cmath>

#include "robust/choice_search.hpp"
#include "robust/leverage.hpp"

namespace egocal {

namespace {

using namespace detail;

/// The split as its own limits have it: every kept part below its limit, every outlier above.
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

}  // namespace egocal
