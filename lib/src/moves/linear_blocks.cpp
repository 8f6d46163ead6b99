// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "moves/linear_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "egocal/estimation/attenuation.hpp"
#include "egocal/problem/cost.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/statistics/median.hpp"
#include "linear_algebra/small_factor.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "solvers/minimiser.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

DualQuaternion minimiser(const std::vector<Statistics>& blocks, const Problem& problem) {
  return detail::minimiser(cost_matrix(sum_blocks(blocks), problem.balance), problem.mode);
}

/// The directions in which an extrinsic can move, columns.
using Directions = Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, 6>;
Directions directions(const DualQuaternion& q, Mode mode) {
  const Matrix86d all = frame_a_basis(q);
  if (mode == Mode::spatial) return all;
  Eigen::Matrix<double, 8, 3> in_plane;
  in_plane << all.col(0), all.col(1), all.col(5);
  return in_plane;
}

}  // namespace

double pair_residual(const MotionPair& pair, const DualQuaternion& q, const Balance& balance) {
  const DualQuaternion a = canonical_sign(pair.a) * q, b = q * canonical_sign(pair.b);
  return balance.rotation * (a.real - b.real).squaredNorm() +
         balance.translation * (a.dual - b.dual).squaredNorm();
}

Problem weighted_by_noise(std::span<const MotionPair> pairs, const Problem& problem,
                          const ChangeTestOptions& options) {
  Problem result = problem;
  if (pairs.size() < 16) return result;
  const std::size_t count = std::clamp<std::size_t>(pairs.size() / 16, 1, 32);
  // a second pass with better weights, as the first answer may be far off
  for (int pass = 0; pass < 2; ++pass) {
    const DualQuaternion q = gated_blocks(pairs, result, count, options).q;
    std::vector<double> rotations, translations;
    for (const MotionPair& pair : pairs) {
      rotations.push_back(pair_residual(pair, q, {1, 0}));
      translations.push_back(pair_residual(pair, q, {0, 1}));
    }
    const double balance = median(std::move(rotations)) / median(std::move(translations));
    if (!(balance > 1e-12 && balance < 1e12)) return result;
    result.balance = {1, balance};
  }
  return result;
}

std::size_t overlap_of(std::span<const MotionPair> pairs) {
  std::vector<double> counts;
  for (std::size_t i = 0; i < std::min<std::size_t>(pairs.size(), 200); ++i) {
    std::size_t next = i + 1;
    while (next < pairs.size() && pairs[next].begin_us >= pairs[i].begin_us &&
           pairs[next].begin_us < pairs[i].end_us)
      ++next;
    counts.push_back(static_cast<double>(next - i));
  }
  return counts.empty() ? 1 : static_cast<std::size_t>(median(counts));
}

Gated gated_blocks(std::span<const MotionPair> pairs, const Problem& problem, std::size_t count,
                   const ChangeTestOptions& options) {
  Gated result;
  result.blocks.resize(count);
  result.kept.resize(count);
  const auto begin = [&](std::size_t block) { return block * pairs.size() / count; };
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t i = begin(k); i < begin(k + 1); ++i) {
      result.blocks[k].add(pairs[i]);
      result.kept[k].push_back(i);
    }
  result.q = minimiser(result.blocks, problem);
  bool changed = false;
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<double> residuals;
    for (std::size_t i = begin(k); i < begin(k + 1); ++i)
      residuals.push_back(pair_residual(pairs[i], result.q, problem.balance));
    if (residuals.size() < 5) continue;
    const double limit = options.most_residual * median(residuals);
    if (*std::max_element(residuals.begin(), residuals.end()) <= limit) continue;
    changed = true;
    result.blocks[k] = {};
    result.kept[k].clear();
    for (std::size_t i = begin(k); i < begin(k + 1); ++i) {
      if (residuals[i - begin(k)] > limit) continue;
      result.blocks[k].add(pairs[i]);
      result.kept[k].push_back(i);
    }
  }
  if (changed) result.q = minimiser(result.blocks, problem);
  return result;
}

namespace {

/// Mean time of pairs [from, to), scaled to -1 at the beginning and 1 at the end. Long drives are thinned
/// unevenly, so an index does not show the time.
double time_of(std::span<const MotionPair> pairs, std::size_t from, std::size_t to) {
  const auto middle = [&](std::size_t i) {
    return 0.5 * static_cast<double>(pairs[i].begin_us - pairs.front().begin_us) +
           0.5 * static_cast<double>(pairs[i].end_us - pairs.front().begin_us);
  };
  double sum = 0;
  for (std::size_t i = from; i < to; ++i) sum += middle(i);
  const auto span = static_cast<double>(pairs.back().end_us - pairs.front().begin_us);
  return from < to && span > 0 ? 2 * sum / (static_cast<double>(to - from) * span) - 1 : 0;
}

/// The common optimum of a block and its neighbours, with some curvature of the whole drive added.
Parameters local_optimum(const std::vector<LinearBlock>& blocks, std::size_t k,
                         const ParameterMatrix& borrowed) {
  Parameters g = blocks[k].g;
  ParameterMatrix H = borrowed + blocks[k].H;
  for (const std::size_t i : {k - 1, k + 1}) {
    if (i >= blocks.size()) continue;  // of 0 - 1, too
    g += blocks[i].g;
    H += blocks[i].H;
  }
  return -SmallFactor(H).solve(g);
}

/// Q of statistics, without the noise of their own rotations.
Matrix8d cost_without_noise(const Statistics& statistics, const Balance& balance,
                            const std::optional<Attenuation>& attenuation) {
  Matrix8d Q = cost_matrix(statistics, balance);
  if (attenuation) {
    const Eigen::Vector4d r = attenuation->r;
    Q.bottomRightCorner<4, 4>() -= r.dot(Q.bottomRightCorner<4, 4>() * r) * attenuation->taken_off;
  }
  return Q;
}

/// Sum e e' of the gradients of each block's motions, at the optimum of the block and its neighbours, which a
/// change elsewhere does not touch.
std::vector<ParameterMatrix> noise_of_motions(const Gated& gated, std::span<const MotionPair> pairs,
                                              const Problem& problem, const Multipliers& lambda,
                                              const Directions& T, const ParameterMatrix& H_mean,
                                              const Linearised& stretch,
                                              const std::optional<Attenuation>& attenuation,
                                              const ChangeTestOptions& options) {
  const Matrix8d constraints = lagrangian_matrix(Matrix8d::Zero(), lambda);
  std::vector<ParameterMatrix> result;
  for (std::size_t k = 0; k < stretch.blocks.size(); ++k) {
    const Parameters x = local_optimum(stretch.blocks, k, options.borrowed_curvature * H_mean);
    const Vector8d shift = T * x, at = stretch.q.vec() + shift;
    const Parameters of_constraints = T.transpose() * (constraints * shift);
    ParameterMatrix sum = ParameterMatrix::Zero(H_mean.rows(), H_mean.cols());
    for (const std::size_t i : gated.kept[k]) {
      Statistics one;
      one.add(pairs[i]);
      const Matrix8d Q = in_units_of(stretch.length, cost_without_noise(one, problem.balance, attenuation));
      const Parameters e = one.weight * (T.transpose() * (Q * at) + of_constraints);
      sum += e * e.transpose();
    }
    result.push_back(sum);
  }
  return result;
}

/// The covariance of the noise in each block's gradient, up to a factor that all have in common: that of its
/// own motions, of which a block has few, and the shape of its curvature with the same size. The curvature
/// alone is wrong by as much as the noise of motions grows with their size.
std::vector<ParameterMatrix> noise_of_blocks(std::vector<ParameterMatrix> noise,
                                             const ParameterMatrix& H_mean, const Linearised& stretch,
                                             const ChangeTestOptions& options) {
  ParameterMatrix mean = ParameterMatrix::Zero(H_mean.rows(), H_mean.cols());
  for (const ParameterMatrix& own : noise) mean += own / static_cast<double>(noise.size());
  // in units of the curvature, in which the test compares costs
  const double unit = mean.diagonal().cwiseQuotient(H_mean.diagonal()).mean();
  const SmallFactor whole(mean);
  const bool known = unit > 0 && std::isfinite(unit) && whole.positive();
  for (std::size_t k = 0; k < noise.size(); ++k) {
    const ParameterMatrix shape = stretch.blocks[k].H + options.raised_curvature * H_mean;
    const double size = whole.solve(noise[k]).trace() / whole.solve(shape).trace();
    if (known && std::isfinite(size))
      noise[k] = (options.own_noise * noise[k] + (1 - options.own_noise) * size * shape +
                  options.raised_noise * mean) /
                 unit;
    else
      noise[k] = shape;
  }
  return noise;
}

/// Sets the square roots of the noise's covariance.
void set_roots(const ParameterMatrix& noise, LinearBlock& block) {
  const SymmetricEigen<Eigen::Dynamic> eigen = symmetric_eigen<Eigen::Dynamic>(noise);
  const double floor = std::max(1e-12 * noise.trace(), 1e-300);
  const Parameters roots = eigen.values.cwiseMax(floor).cwiseSqrt();
  block.root = eigen.vectors * roots.asDiagonal() * eigen.vectors.transpose();
  block.inverse_root = eigen.vectors * roots.cwiseInverse().asDiagonal() * eigen.vectors.transpose();
}

}  // namespace

Linearised linearise(std::span<const MotionPair> pairs, const Problem& problem, std::size_t count,
                     const ChangeTestOptions& options) {
  Linearised result;
  const Gated gated = gated_blocks(pairs, problem, count, options);
  const Statistics all = sum_blocks(gated.blocks);
  Matrix8d Q_metres = cost_matrix(all, problem.balance);
  if (!Q_metres.allFinite() || !(Q_metres.diagonal().maxCoeff() > 0)) return result;
  DualQuaternion q = gated.q;
  std::optional<Attenuation> attenuation;
  if (problem.mode == Mode::spatial) {
    Problem whole = problem;
    whole.blocks = {all};
    attenuation = whole_attenuation(whole);
    if (attenuation) {
      Q_metres = cost_without_noise(all, problem.balance, attenuation);
      q = solve_dual(Q_metres).q;
    }
  }
  result.length = length_scale(Q_metres);
  result.q = in_units_of(result.length, q);
  const Matrix8d Q = in_units_of(result.length, Q_metres);
  const Multipliers lambda = least_squares_multipliers(Q, result.q);
  const Directions T = directions(result.q, problem.mode);
  const Vector8d v = result.q.vec();
  const ParameterMatrix H_mean = T.transpose() * lagrangian_matrix(Q, lambda) * T;
  const double whole = static_cast<double>(gated.blocks.size());
  for (std::size_t k = 0; k < gated.blocks.size(); ++k) {
    const Statistics& statistics = gated.blocks[k];
    const double share = statistics.weight / all.weight * whole;  // 1 for blocks of equal weight
    const Matrix8d Q_block =
        in_units_of(result.length, cost_without_noise(statistics, problem.balance, attenuation));
    LinearBlock block;
    block.Q = share * in_units_of(result.length, cost_matrix(statistics, problem.balance));
    block.g = share * (T.transpose() * (Q_block * v));
    block.H = share * (T.transpose() * lagrangian_matrix(Q_block, lambda) * T);
    const std::size_t from = k * pairs.size() / count;
    block.time = time_of(pairs, from, (k + 1) * pairs.size() / count);
    result.blocks.push_back(std::move(block));
    result.begin.push_back(from);
  }
  const std::vector<ParameterMatrix> noise = noise_of_blocks(
      noise_of_motions(gated, pairs, problem, lambda, T, H_mean, result, attenuation, options), H_mean,
      result, options);
  for (std::size_t k = 0; k < noise.size(); ++k) set_roots(noise[k], result.blocks[k]);
  return result;
}

}  // namespace egocal::detail
