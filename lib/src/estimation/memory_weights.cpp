// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/memory_weights.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/noise_growth.hpp"
#include "solvers/minimiser.hpp"

namespace egocal::detail {

namespace {

Matrix8d weighted_sum(const StrideLadder& ladder, const StrideWeights& weights) {
  Statistics sum;
  for (std::size_t i = 0; i < ladder.size(); ++i)
    if (weights.rotation[i] > 0 || weights.translation[i] > 0)
      add_weighted(sum, ladder.sums[i], weights.rotation[i], weights.translation[i]);
  return sum.weight > 0 ? Matrix8d(sum.dual_rows / sum.weight) : sum.dual_rows;
}

/// lambda of variances 2 a + b s of motions of s steps: lambda + 1 / lambda = 2
/// + b / a, from the precision matrix of a random walk seen through white
/// noise.
double fitted_lambda(const StrideLadder& ladder, const std::vector<double>& variances,
                     const std::vector<double>& counts) {
  const std::optional<double> growth = best_growth(
      {ladder.strides, variances, independent_motions(ladder, counts)}, growth_grid(ladder.options));
  if (!growth) return 0;
  const double half = 1 + 0.5 * *growth;
  return half - std::sqrt(half * half - 1);
}

/// Variances of translations of each stride, without what rotations cause.
struct OwnTranslations {
  std::vector<double> variances;  ///< [m^2]
  std::vector<double> parts;      ///< of the whole variance
  std::vector<double> counts;     ///< motions, by what they say of these variances
};

/// An error of rotation (real rows, |e|^2) moves the dual rows of a motion of
/// length |t| by |t|^2 / 4 |e|^2, (15). Long motions show it even where noise on
/// poses alone makes rotations of all strides alike. It is no noise of motions.
/// In the plane it stays: residuals of rotations have one axis there, and long
/// motions would win for noise that their spread misses (9 instead of 6 of 100
/// drives, tests/lib/test_missed_noise.cpp).
OwnTranslations own_translations(const StrideLadder& ladder, const StrideResiduals& residual, Mode mode) {
  OwnTranslations own;
  for (std::size_t i = 0; i < ladder.size(); ++i) {
    const Statistics& motions = ladder.sums[i].motions;
    // the trace is |t_a|^2 + |t_b|^2 a motion, less what their screws share
    const double squared_half_length =
        motions.weight > 0 ? motions.dual_rows.topLeftCorner<4, 4>().trace() / (8 * motions.weight) : 0;
    const double all = residual.translation[i], of_rotations = residual.rotation[i] * squared_half_length;
    const bool is_told_apart = all > 0 && mode != Mode::planar;
    const double part = is_told_apart ? std::max(ladder.options.least_own_part, 1 - of_rotations / all) : 1;
    own.variances.push_back(part * all);
    own.parts.push_back(part);
    // a difference scatters as what it is a part of does
    own.counts.push_back(ladder.motions[i] * part * part);
  }
  return own;
}

/// Weight of a motion of each stride, before rotation and translation are balanced. Strides whose motions are
/// lost in the rounding of the others are skipped: most of them, where noise adds up from step to step.
std::vector<double> shape(const StrideLadder& ladder, double lambda, const std::vector<double>& counts) {
  std::vector<double> weights;
  for (std::size_t i = 0; i < ladder.size(); ++i) {
    const double part = std::pow(lambda, ladder.strides[i] - 1);
    weights.push_back(counts[i] > 0 && part > ladder.options.negligible_part ? ladder.width[i] * part : 0);
  }
  return weights;
}

double weighted_mean(const std::vector<double>& values, const std::vector<double>& weights,
                     const std::vector<double>& counts) {
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += weights[i] * counts[i] * values[i];
    total += weights[i] * counts[i];
  }
  return total > 0 ? sum / total : 0;
}

/// Rotation and translation by the inverse of their mean squared residuals,
/// each normalised to one in all.
StrideWeights balanced(const StrideLadder& ladder, StrideWeights shapes, const StrideResiduals& residual) {
  const double rotation = weighted_mean(residual.rotation, shapes.rotation, ladder.turns);
  const double translation = weighted_mean(residual.translation, shapes.translation, ladder.motions);
  double n_turns = 0, n_motions = 0;
  for (std::size_t i = 0; i < ladder.size(); ++i) {
    n_turns += shapes.rotation[i] * ladder.turns[i];
    n_motions += shapes.translation[i] * ladder.motions[i];
  }
  const auto [lengths, turns] = ladder.squared_size();
  double ratio = rotation > 0 && translation > 0 ? translation / rotation : 1;
  if (lengths > 0 && turns > 0)
    ratio = std::clamp(ratio, lengths / turns / ladder.options.most_imbalance,
                       lengths / turns * ladder.options.most_imbalance);
  for (double& weight : shapes.rotation) weight *= n_turns > 0 ? ratio / n_turns : 0;
  for (double& weight : shapes.translation) weight *= n_motions > 0 ? 1 / n_motions : 0;
  return shapes;
}

/// The choice of these weights, with their mean stride and the ratio of the weights.
WeightChoice completed(const StrideLadder& ladder, StrideWeights weights, const DualQuaternion& q,
                       double memory) {
  WeightChoice choice{std::move(weights), q, memory, 1, 1, true, {}};
  double rotation = 0, translation = 0, strides = 0;
  for (std::size_t i = 0; i < ladder.size(); ++i) {
    rotation += choice.weights.rotation[i] * ladder.turns[i];
    translation += choice.weights.translation[i] * ladder.motions[i];
    strides += choice.weights.translation[i] * ladder.motions[i] * ladder.strides[i];
  }
  if (translation > 0) {
    choice.mean_stride = strides / translation;
    choice.ratio = rotation / translation;
  }
  return choice;
}

}  // namespace

std::optional<WeightChoice> weights_by_residuals(const StrideLadder& ladder, Mode mode) {
  const auto [lengths, turns] = ladder.squared_size();
  if (!(lengths > 0) || !(ladder.motions.front() > 0)) return std::nullopt;
  const ResidualWeightOptions& options = ladder.options;
  StrideWeights weights{shape(ladder, options.first_lambda, ladder.turns),
                        shape(ladder, options.first_lambda, ladder.motions)};
  weights = balanced(ladder, std::move(weights),
                     {std::vector<double>(ladder.size(), options.first_rotation),
                      std::vector<double>(ladder.size(), options.first_translation)});
  DualQuaternion q = minimiser(weighted_sum(ladder, weights), mode);
  for (int round = 0; round < options.rounds; ++round) {
    const StrideResiduals residual = residuals(ladder, q);
    const OwnTranslations own = own_translations(ladder, residual, mode);
    weights = {shape(ladder, fitted_lambda(ladder, residual.rotation, ladder.turns), ladder.turns),
               shape(ladder, fitted_lambda(ladder, own.variances, own.counts), ladder.motions)};
    for (std::size_t i = 0; i < ladder.size(); ++i) weights.translation[i] *= own.parts[i];
    weights = balanced(ladder, std::move(weights), residual);
    q = minimiser(weighted_sum(ladder, weights), mode);
  }
  return completed(ladder, std::move(weights), q, 0);
}

WeightChoice weights_by_memory(const StrideLadder& ladder, Mode mode, double memory, DualQuaternion q) {
  const double lambda = std::exp(-1 / memory);
  StrideWeights weights;
  for (int round = 0; round < ladder.options.later_rounds; ++round) {
    weights = balanced(ladder, {shape(ladder, lambda, ladder.turns), shape(ladder, lambda, ladder.motions)},
                       residuals(ladder, q));
    q = minimiser(weighted_sum(ladder, weights), mode);
  }
  return completed(ladder, std::move(weights), q, memory);
}

}  // namespace egocal::detail
