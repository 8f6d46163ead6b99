// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/estimation/weighting.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "estimation/misfit.hpp"
#include "estimation/missed_noise.hpp"
#include "estimation/noise_growth.hpp"
#include "estimation/spread_by_poses.hpp"
#include "solvers/minimiser.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal {

namespace {

using detail::SeenDirections;
using detail::spread_by_poses;
using detail::SpreadByPoses;
using detail::standard_error;

/// The strides with enough motions, their sums, and how many strides each represents.
struct Ladder {
  const ResidualWeightOptions& options;
  std::vector<StrideCell> sums;
  std::vector<double> strides, width, motions, turns;

  template <typename Sums>
  Ladder(const StrideBlocks& blocks, const Sums& totals, const ResidualWeightOptions& tuning)
      : options(tuning) {
    for (std::size_t i = 0; i < blocks.strides().size(); ++i) {
      sums.push_back(totals.total(i));
      const StrideCell& sum = sums.back();
      const double translations = sum.motions.weight;
      strides.push_back(blocks.strides()[i].stride);
      motions.push_back(sum.motions.count < options.least_motions ? 0 : translations);
      turns.push_back(sum.motions.count + sum.rotations.count < options.least_motions
                          ? 0
                          : translations + sum.rotations.weight);
    }
    std::size_t last = 0;
    for (std::size_t i = 0; i < strides.size(); ++i)
      if (turns[i] > 0) last = i;
    for (std::size_t i = 0; i < strides.size(); ++i) {
      const double low = i > 0 ? 0.5 * (strides[i] + strides[i - 1]) : 0.5;
      const double high = i < last ? 0.5 * (strides[i] + strides[i + 1]) : 2 * strides[i] - low;
      width.push_back(std::max(1.0, high - low));
    }
  }

  std::size_t size() const { return strides.size(); }

  /// Motion of all strides, squared: lengths [m^2] and turns.
  std::pair<double, double> squared_size() const {
    double lengths = 0, squared_turns = 0;
    for (const StrideCell& sum : sums) {
      lengths += sum.motions.dual_rows.topLeftCorner<4, 4>().trace();
      squared_turns += sum.motions.dual_rows.bottomRightCorner<4, 4>().trace();
    }
    return {lengths, squared_turns};
  }
};

Matrix8d weighted_sum(const Ladder& ladder, const StrideWeights& weights) {
  Statistics sum;
  for (std::size_t i = 0; i < ladder.size(); ++i)
    if (weights.rotation[i] > 0 || weights.translation[i] > 0)
      add_weighted(sum, ladder.sums[i], weights.rotation[i], weights.translation[i]);
  return sum.weight > 0 ? Matrix8d(sum.dual_rows / sum.weight) : sum.dual_rows;
}

using detail::minimiser;

/// Mean squared residuals of one motion of each stride at q, of the real rows and of the dual rows.
struct Residuals {
  std::vector<double> rotation, translation;
};

Residuals residuals(const Ladder& ladder, const DualQuaternion& q) {
  Residuals result;
  const Vector8d v = q.vec();
  for (std::size_t i = 0; i < ladder.size(); ++i) {
    const Matrix8d& motions = ladder.sums[i].motions.dual_rows;
    const Eigen::Matrix4d turns =
        motions.bottomRightCorner<4, 4>() + ladder.sums[i].rotations.dual_rows.bottomRightCorner<4, 4>();
    const double n_turns = std::max(1.0, ladder.turns[i]), n_motions = std::max(1.0, ladder.motions[i]);
    result.rotation.push_back(std::max(ladder.options.least_variance, q.real.dot(turns * q.real) / n_turns));
    result.translation.push_back(std::max(ladder.options.least_variance, v.dot(motions * v) / n_motions));
  }
  return result;
}

/// Ascending; of 0, noise on poses alone, the fitted weights are those of all strides alike.
std::vector<double> growths(const ResidualWeightOptions& o) {
  std::vector<double> result{0};
  for (int k = 0; k <= o.grid; ++k)
    result.push_back(o.least_growth *
                     std::pow(o.most_growth / o.least_growth, static_cast<double>(k) / o.grid));
  return result;
}

/// Motions that share no step, of each stride.
std::vector<double> independent(const Ladder& ladder, const std::vector<double>& counts) {
  std::vector<double> result;
  for (std::size_t i = 0; i < ladder.size(); ++i) result.push_back(counts[i] / ladder.strides[i]);
  return result;
}

/// lambda of variances 2 a + b s of motions of s steps: lambda + 1 / lambda = 2 + b / a, from the precision
/// matrix of a random walk seen through white noise.
double fitted_lambda(const Ladder& ladder, const std::vector<double>& variances,
                     const std::vector<double>& counts) {
  const std::optional<double> growth =
      detail::best_growth({ladder.strides, variances, independent(ladder, counts)}, growths(ladder.options));
  if (!growth) return 0;
  const double half = 1 + 0.5 * *growth;
  return half - std::sqrt(half * half - 1);
}

/// Per motion, before rotation and translation are balanced. Strides whose motions are lost in the rounding
/// of the others are skipped: most of them, where noise adds up from step to step.
std::vector<double> shape(const Ladder& ladder, double lambda, const std::vector<double>& counts) {
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

/// Rotation and translation by the inverse of their mean squared residuals, each normalised to one in all.
StrideWeights balanced(const Ladder& ladder, StrideWeights shapes, const Residuals& residual) {
  const std::vector<double> ones(ladder.size(), 1.0);
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

WeightChoice completed(const Ladder& ladder, StrideWeights weights, const DualQuaternion& q, double memory) {
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

std::optional<WeightChoice> residual_weights(const Ladder& ladder, Mode mode) {
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
    const Residuals residual = residuals(ladder, q);
    weights = {shape(ladder, fitted_lambda(ladder, residual.rotation, ladder.turns), ladder.turns),
               shape(ladder, fitted_lambda(ladder, residual.translation, ladder.motions), ladder.motions)};
    weights = balanced(ladder, std::move(weights), residual);
    q = minimiser(weighted_sum(ladder, weights), mode);
  }
  return completed(ladder, std::move(weights), q, 0);
}

WeightChoice with_memory(const Ladder& ladder, Mode mode, double memory, DualQuaternion q) {
  const double lambda = std::exp(-1 / memory);
  StrideWeights weights;
  for (int round = 0; round < ladder.options.later_rounds; ++round) {
    weights = balanced(ladder, {shape(ladder, lambda, ladder.turns), shape(ladder, lambda, ladder.motions)},
                       residuals(ladder, q));
    q = minimiser(weighted_sum(ladder, weights), mode);
  }
  return completed(ladder, std::move(weights), q, memory);
}

std::string reason_without_spread(const WeightChoice& choice) {
  char text[200];
  std::snprintf(text, sizeof text,
                "sum over strides, %.1f steps in the mean, weighted by the residuals, which no single stride "
                "explains as well",
                choice.mean_stride);
  return text;
}

std::string reason(const WeightChoice& choice, const SpreadByPoses& spread) {
  char text[200];
  std::snprintf(
      text, sizeof text,
      "sum over strides, %.1f steps in the mean, weighted by the residuals%s: spread %.3f deg, %.2f cm",
      choice.mean_stride, choice.memory > 0 ? " and the jack-knife" : "",
      spread.rotation * 180 / std::numbers::pi, 100 * spread.translation);
  return text;
}

/// By how much the noise of motions grows with their steps, relative to that of poses: what the residuals of
/// the rotations show beyond doubt, or in the plane most likely. Those of translations also grow with the
/// rotations' noise. Noise that is forgotten within a block of instants is noise on poses as far as omitting
/// blocks is concerned.
double noise_growth(const Ladder& ladder, const Residuals& residual, std::uint64_t block_length, Mode mode,
                    const WeightingOptions& options) {
  const double evidence = mode == Mode::planar ? options.growth_evidence_in_plane : options.growth_evidence;
  detail::StrideVariances seen{ladder.strides, residual.rotation, independent(ladder, ladder.turns)};
  for (std::size_t i = 0; i < ladder.size(); ++i)
    if (ladder.strides[i] < static_cast<double>(block_length)) seen.independent[i] = 0;
  return detail::least_growth(seen, growths(options.residuals), evidence);
}

/// Spreads of shorter blocks [instants] choose no memory. Such blocks are shorter than the noise lasts that a
/// memory is for, and their spreads say too little of long motions. In drives of 20 motions with noise of a
/// memory of four steps they chose long ones for every third, whose errors were four times what blocks said;
/// without it translations err by a sixth less (docs/accuracy.md, "No memory in short drives").
constexpr std::uint64_t least_block_for_memory = 4;

/// The memories that may be better than the weights by the residuals. Where noise on poses and on motions
/// explains the residuals, no memory is that they refute: the smallest of several noisy spreads would
/// mislead.
std::vector<double> possible_memories(const Ladder& ladder, const Residuals& residual,
                                      std::uint64_t block_length, const WeightingOptions& options) {
  if (block_length < least_block_for_memory) return {};
  const auto fit = [&](const std::vector<double>& variances, const std::vector<double>& counts) {
    return detail::fit_noise({ladder.strides, variances, independent(ladder, counts)},
                             growths(options.residuals), options.least_independent);
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

class Trials {
 public:
  Trials(const TouchingSums& sums, const Problem& problem, const Ladder& ladder, std::uint64_t block_length,
         const WeightingOptions& options)
      : sums_(sums), problem_(problem), ladder_(ladder), block_length_(block_length), options_(options) {}

  /// Without it no spread is corrected.
  void judge_noise(const Residuals& residual) {
    growth_ = noise_growth(ladder_, residual, block_length_, problem_.mode, options_);
  }
  /// False where the blocks are too few for a spread.
  bool set(const StrideWeights& weights) {
    sums_.weighted(weights).fill(problem_);
    weights_ = weights;
    return problem_.blocks.size() >= options_.least_blocks;
  }
  SeenDirections seen() const { return detail::seen_directions(problem_); }
  /// With the noise that omitting blocks misses.
  SpreadByPoses spread(const SeenDirections& seen) const {
    SpreadByPoses result = spread_by_poses(problem_, seen);
    const auto missed = [&](const std::vector<double>& weights) {
      return detail::missed_noise(ladder_.strides, weights, growth_, block_length_);
    };
    result.widen(missed(weights_.rotation), missed(weights_.translation));
    return result;
  }

 private:
  const TouchingSums& sums_;
  Problem problem_;
  const Ladder& ladder_;
  std::uint64_t block_length_;
  const WeightingOptions& options_;
  StrideWeights weights_;
  double growth_ = 0;
};

/// Whether the sum's answer is where motions of one stride, judged one by one, allow it to be. shorter: the
/// sum's motions are shorter than those.
bool agree(const SpreadByPoses& sum, const SpreadByPoses& single, bool shorter, const SeenDirections& seen,
           const WeightingOptions& options) {
  const auto difference = detail::frame_a_difference(single.T_a_b, sum.T_a_b);
  double translation = 0, rotation = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!seen[i]) continue;
    const double here = std::abs(difference[static_cast<Eigen::Index>(i)]);
    const double least =
        i < 3 ? options.residuals.least_translation_spread : options.residuals.least_rotation_spread;
    if (shorter && here > options.contradicts * single.stddev[i] + least) return false;
    (i < 3 ? translation : rotation) += here * here;
  }
  return std::sqrt(translation) <=
             options.agreement * single.translation + options.residuals.least_translation_spread &&
         std::sqrt(rotation) <= options.agreement * single.rotation + options.residuals.least_rotation_spread;
}

/// How likely answers are by what they leave of the rival's motions.
class ByRivalsMotions {
 public:
  ByRivalsMotions(const SingleStride& rival, const WeightingOptions& options)
      : sum_(sum_blocks(rival.problem.blocks)), options_(options) {
    if (sum_.weight > 0) of_rival_ = misfit(minimiser(cost_matrix(rival.problem), rival.problem.mode));
  }
  bool refute_rival(const DualQuaternion& q) const { return of_rival_ - misfit(q) > limit(); }
  bool refute(const DualQuaternion& q) const { return misfit(q) - of_rival_ > limit(); }

 private:
  double limit() const { return std::log(options_.less_likely); }
  double misfit(const DualQuaternion& q) const {
    return detail::misfit(sum_, q, options_.residuals.least_rotation_spread,
                          options_.residuals.least_translation_spread);
  }

  Statistics sum_;
  const WeightingOptions& options_;
  double of_rival_ = 0;
};

/// The part of the neighbouring steps' weight that was taken off as their residuals are far from typical.
double weight_taken_off(const Ladder& ladder) {
  const Statistics& steps = ladder.sums.front().motions;
  return steps.count > 0 ? 1 - steps.weight / static_cast<double>(steps.count) : 0;
}

/// Whether the sum's spread is clearly smaller than that of motions of one stride.
bool beats(const SpreadByPoses& sum, double mean_stride, const SingleStride& rival, bool in_force,
           const Ladder& ladder, Trials& trials, const SeenDirections& seen,
           const WeightingOptions& options) {
  std::optional<SpreadByPoses> own;  // the rival as it is, in its own blocks
  if (rival.problem.blocks.size() >= options.least_blocks) own = spread_by_poses(rival.problem, seen);
  const auto place = std::find(ladder.strides.begin(), ladder.strides.end(), rival.stride);
  const bool shorter = mean_stride < rival.stride;
  if (place == ladder.strides.end() || (own && !agree(sum, *own, shorter, seen, options))) return false;
  if (own && std::isfinite(own->score) && weight_taken_off(ladder) > options.taken_off &&
      own->score - sum.score >= (in_force ? 0 : options.clearly_unpaired))
    return true;

  StrideWeights alone{std::vector<double>(ladder.size(), 0.0), std::vector<double>(ladder.size(), 0.0)};
  const auto i = static_cast<std::size_t>(place - ladder.strides.begin());
  alone.rotation[i] = rival.balance.rotation;
  alone.translation[i] = rival.balance.translation;
  if (!trials.set(alone)) return false;
  const SpreadByPoses single = trials.spread(seen);
  if (!std::isfinite(single.score)) return true;
  if (single.influence.size() != sum.influence.size()) return false;
  if (single.rotation < options.residuals.least_rotation_spread &&
      single.translation < options.residuals.least_translation_spread)
    return false;
  const double gain = single.score - sum.score;
  if (in_force) return gain > 0;
  return gain >= std::max(options.clearly, options.single_evidence * standard_error(single, sum));
}

}  // namespace

std::optional<WeightChoice> residual_weights(const StrideBlocks& blocks, Mode mode,
                                             const ResidualWeightOptions& options) {
  return residual_weights(Ladder(blocks, blocks, options), mode);
}

std::optional<WeightChoice> choose_weights(const StrideBlocks& blocks, const TouchingSums& sums,
                                           const Problem& problem, const std::optional<WeightChoice>& current,
                                           const std::optional<SingleStride>& rival,
                                           const WeightingOptions& options) {
  const Ladder ladder(blocks, sums, options.residuals);
  std::optional<WeightChoice> best = residual_weights(ladder, problem.mode);
  if (!best) return std::nullopt;
  std::optional<ByRivalsMotions> likelihood;
  if (rival) likelihood.emplace(*rival, options);
  // where the rival is at a wrong minimum the residuals decide, though no spread may tell how well
  std::optional<WeightChoice> without_spread;
  if (likelihood && likelihood->refute_rival(best->q)) {
    without_spread = best;
    without_spread->reason = reason_without_spread(*best);
  }
  const Residuals residual = residuals(ladder, best->q);
  std::vector<WeightChoice> others;
  for (const double memory : possible_memories(ladder, residual, blocks.state().block_length, options))
    others.push_back(with_memory(ladder, problem.mode, memory, best->q));

  // what one of them shows counts for all: a direction is seen or not by the motion, not by the weights
  Trials trials(sums, problem, ladder, blocks.state().block_length, options);
  trials.judge_noise(residual);
  SeenDirections seen{};
  if (!others.empty() && trials.set(others.back().weights)) seen = trials.seen();
  if (!trials.set(best->weights)) return without_spread;
  const SeenDirections more = trials.seen();
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = seen[i] || more[i];
  if (std::none_of(seen.begin(), seen.end(), [](bool direction) { return direction; })) return without_spread;

  const SpreadByPoses reference = trials.spread(seen);
  SpreadByPoses least = reference;
  const auto bonus = [&](const WeightChoice& choice) {
    return current && current->memory == choice.memory ? options.hysteresis : 0;
  };
  const bool reference_fails = !std::isfinite(reference.score);
  double least_score =
      reference_fails ? std::numeric_limits<double>::infinity() : reference.score - bonus(*best);
  for (WeightChoice& choice : others) {
    if (!trials.set(choice.weights)) continue;
    SpreadByPoses here = trials.spread(seen);
    if (!std::isfinite(here.score) || here.influence.size() != reference.influence.size()) continue;
    const double score = here.score - bonus(choice);
    if (score >= least_score) continue;
    if (!reference_fails && reference.score - here.score < options.evidence * standard_error(reference, here))
      continue;
    best = std::move(choice);
    least = std::move(here);
    least_score = score;
  }
  if (!std::isfinite(least.score)) return without_spread;
  if (rival && !likelihood->refute_rival(best->q))
    best->beats_single = !likelihood->refute(best->q) &&
                         beats(least, best->mean_stride, *rival, current && current->beats_single, ladder,
                               trials, seen, options);
  best->reason = reason(*best, least);
  return best;
}

}  // namespace egocal
