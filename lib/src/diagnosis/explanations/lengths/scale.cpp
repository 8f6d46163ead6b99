// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/lengths/scale.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/scale/solve_scale.hpp"
#include "egocal/solvers/global.hpp"

namespace egocal::detail {

namespace {

/// The 8 x 8 cost as a polynomial in the scale of b: rotation + (zero + s one + s^2 two) / s. Dividing by s
/// makes a and b alike: neither is shrunk to explain noise.
struct ScaledCost {
  Matrix8d rotation = Matrix8d::Zero(), zero = Matrix8d::Zero(), one = Matrix8d::Zero(),
           two = Matrix8d::Zero();

  Matrix8d at(double s) const { return rotation + zero / s + one + s * two; }
};

ScaledCost accumulate(const Motions& motions, const std::vector<double>& weights) {
  Statistics at_zero, at_plus, at_minus;
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    if (!(weights[i] > 1e-6)) continue;
    const Motion& motion = motions.all[i];
    DualQuaternion b = motion.b;
    b.dual.setZero();
    at_zero.add(motion.a, b, weights[i]);
    at_plus.add(motion.a, motion.b, weights[i]);
    b.dual = -motion.b.dual;
    at_minus.add(motion.a, b, weights[i]);
  }
  const auto weight = [](double size) { return size > 0 ? 4 / (size * size) : 0.0; };
  const double w_t = weight(motions.translation);
  ScaledCost cost;
  const Matrix8d zero = cost_matrix(at_zero, {0, w_t}), plus = cost_matrix(at_plus, {0, w_t}),
                 minus = cost_matrix(at_minus, {0, w_t});
  cost.rotation = cost_matrix(at_zero, {weight(motions.rotation), 0});
  cost.zero = zero;
  cost.one = 0.5 * (plus - minus);
  cost.two = 0.5 * (plus + minus) - zero;
  return cost;
}

double best_scale(const ScaledCost& cost, double centre, const ScaleSearchOptions& options) {
  const auto value = [&](double log_scale) { return solve_dual(cost.at(std::exp(log_scale))).cost; };
  const double low = std::log(centre / options.widest), step = 2 * std::log(options.widest) / options.grid;
  int best = 0;
  double least = value(low);
  for (int i = 1; i <= options.grid; ++i) {
    const double here = value(low + i * step);
    if (here < least) {
      least = here;
      best = i;
    }
  }
  constexpr double golden = 0.6180339887498949;  // mathematics: the golden section
  double left = low + (best - 1) * step, right = low + (best + 1) * step;
  for (int i = 0; i < options.refinements; ++i) {
    const double x = right - golden * (right - left), y = left + golden * (right - left);
    const bool in_left = value(x) < value(y);
    (in_left ? right : left) = in_left ? y : x;
  }
  return std::exp(0.5 * (left + right));
}

/// The scale solved again from the motions in consecutive parts, with the weights of the fit.
ScaleSolution solved_in_parts(const Motions& motions, const ScaledFit& fit, const ScaleCheckOptions& check) {
  const std::size_t count = std::min(check.blocks, motions.blocks);
  std::vector<ScaleStatistics> parts(count);
  const std::size_t n = motions.all.size();
  for (std::size_t i = 0; i < n; ++i)
    parts[i * count / n].add(motions.all[i].a, motions.all[i].b, fit.explained.fit.weights[i]);
  const double length = fit.explained.motions.translation;
  ScaleOptions options;
  options.side = Side::b;
  options.least = 1 / check.widest * fit.scale;
  options.most = check.widest * fit.scale;
  options.balance = {1, length > 0 ? motions.rotation * motions.rotation / (length * length) : 1};
  return solve_scale(parts, options);
}

}  // namespace

ScaledFit fit_with_scale(const Motions& motions, const DiagnosisOptions& options, Effort effort) {
  double length_a = 0, length_b = 0;
  for (const Motion& motion : motions.all) {
    length_a += motion.t_a.norm();
    length_b += motion.t_b.norm();
  }
  ScaledFit result;
  if (!(length_a > 0) || !(length_b > 0)) {
    result.explained = {motions, robust_fit(motions, options.fit)};
    return result;
  }
  std::vector<double> weights(motions.all.size(), 1.0);
  const int rounds = effort == Effort::full ? 3 : 1;
  for (int round = 0; round < rounds; ++round) {
    result.scale = best_scale(accumulate(motions, weights), length_a / length_b, options.scale);
    result.explained.motions = scaled(motions, result.scale);
    result.explained.fit = round + 1 == rounds && effort == Effort::full
                               ? robust_fit(result.explained.motions, options.fit)
                               : quick_fit(result.explained.motions, options.fit);
    weights = result.explained.fit.weights;
  }
  return result;
}

std::optional<double> stddev_of_log_scale(const Motions& motions, const ScaledFit& fit,
                                          std::size_t independent, const ScaleCheckOptions& options) {
  const ScaleSolution solution = solved_in_parts(motions, fit, options);
  const double jackknife = solution.stddev / solution.scale;
  if (!solution.observable || !solution.certified || !std::isfinite(jackknife)) return std::nullopt;
  // least squares: the noise of one of three equations a motion, as a part of what all of them show
  const double noise_share = 2 * solution.attenuation;  // ScaleNoise::both halves it
  const double noise = std::sqrt(noise_share / (3 * static_cast<double>(independent)));
  return std::hypot(jackknife, options.wandering * noise);
}

}  // namespace egocal::detail
