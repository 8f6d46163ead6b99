// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/estimation/weighting.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "egocal/degrees.hpp"
#include "estimation/memory_weights.hpp"
#include "estimation/noise_growth.hpp"
#include "estimation/single_stride_rival.hpp"

namespace egocal {

namespace {

using detail::SeenDirections;
using detail::SpreadByPoses;
using detail::StrideLadder;
using detail::StrideResiduals;
using detail::TrialSpread;

/// Sum over the motions of each stride. sums: StrideBlocks, or TouchingSums of them.
template <typename Sums>
std::vector<StrideCell> totals(const StrideBlocks& blocks, const Sums& sums) {
  std::vector<StrideCell> result;
  for (std::size_t i = 0; i < blocks.strides().size(); ++i) result.push_back(sums.total(i));
  return result;
}

/// Spreads of shorter blocks [instants] choose no memory. Such blocks are
/// shorter than the noise lasts that a memory is for, and their spreads say too
/// little of long motions. In drives of 20 motions with noise of a memory of
/// four steps they chose long ones for every third, whose errors were four
/// times what blocks said; without it translations err by a sixth less
/// (docs/weights.md, "No memory in short drives").
constexpr std::uint64_t least_block_for_memory = 4;

/// The memories that may be better than the weights by the residuals. Where
/// noise on poses and on motions explains the residuals, memories that they
/// refute are left out: the smallest of several noisy spreads would mislead.
std::vector<double> possible_memories(const StrideLadder& ladder, const StrideResiduals& residual,
                                      std::uint64_t block_length, const WeightingOptions& options) {
  if (block_length < least_block_for_memory) return {};
  const auto fit = [&](const std::vector<double>& variances, const std::vector<double>& counts) {
    return detail::fit_noise({ladder.strides, variances, detail::independent_motions(ladder, counts)},
                             detail::growth_grid(options.residuals), options.least_independent);
  };
  const detail::NoiseFit rotation = fit(residual.rotation, ladder.turns);
  const detail::NoiseFit translation = fit(residual.translation, ladder.motions);
  if (std::max(rotation.misfit, translation.misfit) > options.explained) return options.memories;
  std::vector<double> possible;
  for (const double memory : options.memories) {
    const double growth = 2 * std::cosh(1 / memory) - 2;  // lambda + 1 / lambda - 2
    if (!rotation.refutes(growth, options.refuted) && !translation.refutes(growth, options.refuted))
      possible.push_back(memory);
  }
  return possible;
}

struct MeasuredChoice {
  WeightChoice choice;
  SpreadByPoses spread;
};

/// The one with the smallest spread; a memory must be clearly better than the
/// weights by the residuals, unless those have no spread. current: the choice
/// in force.
MeasuredChoice smallest_spread(MeasuredChoice by_residuals, std::vector<WeightChoice> with_memory,
                               TrialSpread& trial, const SeenDirections& seen,
                               const std::optional<WeightChoice>& current, const WeightingOptions& options) {
  const auto bonus = [&](const WeightChoice& choice) {
    return current && current->memory == choice.memory ? options.hysteresis : 0;
  };
  const SpreadByPoses reference = by_residuals.spread;
  const bool reference_fails = !std::isfinite(reference.score);
  MeasuredChoice best = std::move(by_residuals);
  double least_score =
      reference_fails ? std::numeric_limits<double>::infinity() : reference.score - bonus(best.choice);
  for (WeightChoice& choice : with_memory) {
    if (!trial.set(choice.weights)) continue;
    SpreadByPoses here = trial.spread(seen);
    if (!std::isfinite(here.score) || here.influence.size() != reference.influence.size()) continue;
    const double score = here.score - bonus(choice);
    if (score >= least_score) continue;
    if (!reference_fails && reference.score - here.score < options.evidence * standard_error(reference, here))
      continue;
    best = {std::move(choice), std::move(here)};
    least_score = score;
  }
  return best;
}

std::string reason_without_spread(const WeightChoice& choice) {
  char text[200];
  std::snprintf(text, sizeof text,
                "sum over strides, %.1f steps in the mean, weighted by the "
                "residuals, which no single stride "
                "explains as well",
                choice.mean_stride);
  return text;
}

std::string reason(const WeightChoice& choice, const SpreadByPoses& spread) {
  char text[200];
  std::snprintf(text, sizeof text,
                "sum over strides, %.1f steps in the mean, weighted by the residuals%s: "
                "spread %.3f deg, %.2f cm",
                choice.mean_stride, choice.memory > 0 ? " and the jack-knife" : "",
                spread.rotation * degrees_per_radian, 100 * spread.translation);
  return text;
}

/// The motions of the best single stride, without those across jumps.
WeightChoice of_one_stride(const detail::StrideAlone& alone, int stride, const DualQuaternion& q) {
  WeightChoice choice;
  choice.weights = alone.weights;
  choice.q = q;
  choice.mean_stride = stride;
  const auto heaviest = [](const std::vector<double>& weights) {
    return *std::max_element(weights.begin(), weights.end());
  };
  if (heaviest(alone.weights.translation) > 0)
    choice.ratio = heaviest(alone.weights.rotation) / heaviest(alone.weights.translation);
  char text[200];
  std::snprintf(text, sizeof text,
                "sum over strides, %.1f steps in the mean, one stride without motions across jumps: "
                "spread %.3f deg, %.2f cm",
                choice.mean_stride, alone.spread.rotation * degrees_per_radian,
                100 * alone.spread.translation);
  choice.reason = text;
  return choice;
}

}  // namespace

std::optional<WeightChoice> residual_weights(const StrideBlocks& blocks, Mode mode,
                                             const ResidualWeightOptions& options) {
  return weights_by_residuals(StrideLadder(blocks, totals(blocks, blocks), options), mode);
}

std::optional<WeightChoice> choose_weights(const StrideBlocks& blocks, const TouchingSums& sums,
                                           const Problem& problem, const std::optional<WeightChoice>& current,
                                           const std::optional<SingleStride>& rival,
                                           const WeightingOptions& options) {
  const StrideLadder ladder(blocks, totals(blocks, sums), options.residuals);
  std::optional<WeightChoice> by_residuals = weights_by_residuals(ladder, problem.mode);
  if (!by_residuals) return std::nullopt;
  std::optional<detail::SingleStrideRival> single;
  if (rival) single.emplace(*rival, options);
  // where the rival is at a wrong minimum the residuals decide, even if no
  // spread can be measured
  std::optional<WeightChoice> without_spread;
  if (single && single->is_refuted_by(by_residuals->q)) {
    without_spread = by_residuals;
    without_spread->reason = reason_without_spread(*by_residuals);
  }
  const std::uint64_t block_length = blocks.state().block_length;
  const StrideResiduals residual = residuals(ladder, by_residuals->q);
  std::vector<WeightChoice> with_memory;
  for (const double memory : possible_memories(ladder, residual, block_length, options))
    with_memory.push_back(weights_by_memory(ladder, problem.mode, memory, by_residuals->q));

  // a direction is seen or not by the motion, not by the weights: what one
  // choice shows counts for all
  TrialSpread trial(sums, problem, ladder, residual, block_length, options);
  SeenDirections seen{};
  if (!with_memory.empty() && trial.set(with_memory.back().weights)) seen = trial.seen();
  if (!trial.set(by_residuals->weights)) return without_spread;
  const SeenDirections more = trial.seen();
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = seen[i] || more[i];
  if (std::none_of(seen.begin(), seen.end(), [](bool direction) { return direction; })) return without_spread;

  MeasuredChoice reference{std::move(*by_residuals), trial.spread(seen)};
  auto [best, least] =
      smallest_spread(std::move(reference), std::move(with_memory), trial, seen, current, options);
  if (!std::isfinite(least.score)) return without_spread;
  if (single && !single->is_refuted_by(best.q)) {
    best.beats_single =
        !single->refutes(best.q) &&
        single->is_beaten_by(least, best.mean_stride, current && current->beats_single, ladder, trial, seen);
    if (const auto alone = single->without_jumps(ladder, trial, seen);
        alone && (!best.beats_single || alone->spread.score < least.score - options.clearly))
      return of_one_stride(*alone, rival->stride, alone->spread.T_a_b);
  }
  best.reason = reason(best, least);
  return std::move(best);
}

}  // namespace egocal
