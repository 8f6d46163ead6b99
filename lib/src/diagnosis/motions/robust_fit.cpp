// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/robust_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "egocal/solvers/global.hpp"

namespace egocal::detail {

namespace {

/// Squares below this part of the motion are rounding: 1e-8, eight digits of a pose.
constexpr double least_square = 1e-16;

/// Size of a motion in units of the typical one; the smaller of the two, for an outlier makes one of them
/// large.
double size_of(const Motion& motion, const Motions& motions) {
  double size = 0;
  if (motions.rotation > 0) size += std::min(motion.angle_a, motion.angle_b) / motions.rotation;
  if (motions.translation > 0) size += std::min(motion.t_a.norm(), motion.t_b.norm()) / motions.translation;
  return size;
}

double square_of(const Residual& residual, const Motions& motions) {
  const auto part = [](double value, double size) { return size > 0 ? value / size : 0.0; };
  const double rotation = part(residual.rotation, motions.rotation);
  const double translation = part(residual.translation, motions.translation);
  return rotation * rotation + translation * translation;
}

/// Half a turn is four times the sine of a quarter: rotation rows of (14) are half-angles, dual rows
/// half-lengths.
Balance balance_of(const Motions& motions) {
  const auto weight = [](double size) { return size > 0 ? 4 / (size * size) : 0.0; };
  Balance balance{weight(motions.rotation), weight(motions.translation)};
  if (!(balance.translation > 0)) balance.translation = 1;
  return balance;
}

DualQuaternion weighted_solution(const Motions& motions, const std::vector<double>& weights) {
  Statistics statistics;
  for (std::size_t i = 0; i < motions.all.size(); ++i)
    if (weights[i] > 1e-6) statistics.add(motions.all[i].a, motions.all[i].b, weights[i]);
  return solve_dual(cost_matrix(statistics, balance_of(motions))).q;
}

/// weighted_quantile() of many values, at a third of the cost: a few of them say between which limits it
/// lies, and only what is there is sorted. Empty where it is not there, or where the rounding of the sums
/// could decide.
std::optional<double> quantile_by_sample(const std::vector<std::pair<double, double>>& values, double part) {
  // enough that the margin, two standard deviations of the sample's median, leaves a third of the values
  constexpr std::size_t sample_size = 64, few = 256;
  constexpr double margin = 0.14;
  const std::size_t n = values.size();
  if (n < few) return std::nullopt;
  std::array<std::pair<double, double>, sample_size> sample;
  double of_sample = 0;
  for (std::size_t i = 0; i < sample_size; ++i) {
    sample[i] = values[i * n / sample_size];
    of_sample += sample[i].second;
  }
  std::sort(sample.begin(), sample.end());
  double low = -INFINITY, high = INFINITY, passed = 0;
  for (const auto& [value, weight] : sample) {
    passed += weight;
    if (passed < (part - margin) * of_sample) low = value;
    if (passed > (part + margin) * of_sample) {
      high = value;
      break;
    }
  }
  std::vector<std::pair<double, double>> within(n);
  std::size_t count = 0, valid = 0;
  double total = 0, below = 0;
  for (const auto& entry : values) {  // without a branch that the processor could guess wrongly
    const auto [value, weight] = entry;
    total += weight;
    valid += static_cast<unsigned>(value > 0) & static_cast<unsigned>(weight >= 0);
    below += value < low ? weight : 0;
    within[count] = entry;
    count += static_cast<unsigned>(value >= low) & static_cast<unsigned>(value <= high);
  }
  // in whatever order they are added up, sums differ by less
  const double rounding_of_sums = 4 * static_cast<double>(n) * std::numeric_limits<double>::epsilon() * total;
  const double wanted = part * total;
  if (valid != n || !std::isfinite(total) || !(below + rounding_of_sums < wanted)) return std::nullopt;
  within.resize(count);
  std::sort(within.begin(), within.end());
  double sum = below;
  for (const auto& [value, weight] : within) {
    sum += weight;
    if (sum < wanted - rounding_of_sums) continue;
    if (sum < wanted + rounding_of_sums) return std::nullopt;
    return value;
  }
  return std::nullopt;
}

}  // namespace

double weighted_quantile(std::vector<std::pair<double, double>> values, double part) {
  if (values.empty()) return 0;
  if (const std::optional<double> near = quantile_by_sample(values, part)) return *near;
  std::sort(values.begin(), values.end());
  double total = 0, sum = 0;
  for (const auto& entry : values) total += entry.second;
  for (const auto& [value, weight] : values) {
    sum += weight;
    if (sum >= part * total) return value;
  }
  return values.back().first;
}

double weighted_median(std::vector<std::pair<double, double>> values) {
  return weighted_quantile(std::move(values), 0.5);
}

static double misfit_of(const Motions& motions, const RobustFit& fit, double part) {
  std::vector<std::pair<double, double>> values;
  for (std::size_t i = 0; i < motions.all.size(); ++i)
    values.emplace_back(fit.squares[i], size_of(motions.all[i], motions));
  return std::sqrt(weighted_quantile(std::move(values), part));
}

/// Up to two thirds of the motions may be outliers of one kind or another (two of three motions have an end
/// at a wrong pose where a third of the poses are wrong).
double misfit(const Motions& motions, const RobustFit& fit) {
  constexpr double better_third = 1.0 / 3;  // see above
  return misfit_of(motions, fit, better_third);
}

double median_misfit(const Motions& motions, const RobustFit& fit) {
  return misfit_of(motions, fit, 0.5);
}

Residual residual_at(const Motion& motion, const Pose& T) {
  const Eigen::Quaterniond a(motion.a.real[0], motion.a.real[1], motion.a.real[2], motion.a.real[3]);
  const Eigen::Quaterniond b(motion.b.real[0], motion.b.real[1], motion.b.real[2], motion.b.real[3]);
  const Eigen::Quaterniond off = (a * T.rotation).conjugate() * (T.rotation * b);
  Residual residual;
  residual.rotation = 2 * std::atan2(off.vec().norm(), std::abs(off.w()));
  residual.translation =
      (motion.R_a * T.translation + motion.t_a - T.rotation * motion.t_b - T.translation).norm();
  return residual;
}

static std::vector<double> sizes_of(const Motions& motions) {
  std::vector<double> sizes;
  sizes.reserve(motions.all.size());
  for (const Motion& motion : motions.all) sizes.push_back(size_of(motion, motions));
  return sizes;
}

static double weight_of(double square, double limit) {
  const double w = 1 / (1 + square / limit);
  return w * w;
}

/// sizes: of the motions. Without weights.
static RobustFit evaluated(const Motions& motions, const std::vector<double>& sizes,
                           const DualQuaternion& T) {
  RobustFit fit{T, {}, {}, 0};
  const Pose pose = to_pose(T);
  std::vector<std::pair<double, double>> values;
  fit.squares.reserve(motions.all.size());
  values.reserve(motions.all.size());
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    fit.squares.push_back(square_of(residual_at(motions.all[i], pose), motions));
    values.emplace_back(fit.squares.back(), sizes[i]);
  }
  fit.typical = std::max(weighted_median(std::move(values)), least_square);
  return fit;
}

RobustFit evaluated(const Motions& motions, const DualQuaternion& T) {
  RobustFit fit = evaluated(motions, sizes_of(motions), T);
  fit.weights.assign(motions.all.size(), 1.0);
  return fit;
}

/// Weights before anything is known of the extrinsic: whatever it is, both sensors turn by the same angle.
/// The first solution would otherwise be that of the wrong poses, which make the largest motions.
static std::vector<double> first_weights(const Motions& motions, const std::vector<double>& sizes,
                                         double inlier) {
  std::vector<std::pair<double, double>> differences;
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    const double difference = motions.all[i].angle_a - motions.all[i].angle_b;
    differences.emplace_back(difference * difference, sizes[i]);
  }
  const double typical =
      std::max(weighted_median(differences), least_square * motions.rotation * motions.rotation);
  std::vector<double> weights;
  for (const auto& [square, size] : differences)
    weights.push_back(typical > 0 ? weight_of(square, inlier * typical) : 1);
  return weights;
}

static RobustFit reweighted(const Motions& motions, int rounds, double inlier) {
  const std::vector<double> sizes = sizes_of(motions);
  std::vector<double> weights = first_weights(motions, sizes, inlier);
  RobustFit fit;
  for (int round = 0; round < rounds; ++round) {
    fit = evaluated(motions, sizes, weighted_solution(motions, weights));
    for (std::size_t i = 0; i < weights.size(); ++i) {
      weights[i] = weight_of(fit.squares[i], inlier * fit.typical);
    }
  }
  fit.weights = std::move(weights);
  return fit;
}

RobustFit robust_fit(const Motions& motions, const RobustFitOptions& options) {
  return reweighted(motions, options.rounds, options.inlier);
}

RobustFit quick_fit(const Motions& motions, const RobustFitOptions& options) {
  return reweighted(motions, options.quick_rounds, options.inlier);
}

namespace {

struct BlockMeans {
  std::vector<double> logs;  ///< mean of log(square + floor)
  std::vector<int> counts;
};

/// Blocks are intervals of time: explanations with other clocks have other instants.
BlockMeans block_means(const Explained& x, double floor, double begin, double end, std::size_t blocks) {
  BlockMeans means{std::vector<double>(blocks, 0.0), std::vector<int>(blocks, 0)};
  const double width = (end - begin) / static_cast<double>(blocks);
  for (std::size_t i = 0; i < x.motions.all.size(); ++i) {
    const double place = width > 0 ? (x.motions.all[i].time - begin) / width : 0;
    if (place < 0) continue;
    const std::size_t block = std::min(blocks - 1, static_cast<std::size_t>(place));
    means.logs[block] += std::log(x.fit.squares[i] + floor);
    ++means.counts[block];
  }
  for (std::size_t block = 0; block < blocks; ++block)
    if (means.counts[block] > 0) means.logs[block] /= means.counts[block];
  return means;
}

/// Mean of the squares without the largest twentieth, which may be outliers.
double trimmed_mean(std::vector<double> squares) {
  if (squares.empty()) return 0;
  const std::size_t kept = squares.size() - squares.size() / 20;
  std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(kept - 1), squares.end());
  // in the order of size, or the sum would depend on the standard library
  std::sort(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(kept));
  return std::accumulate(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(kept), 0.0) /
         static_cast<double>(kept);
}

/// Signed ranks by size, as a multiple of their standard deviation without any difference.
double signed_rank_sigmas(const std::vector<double>& gains) {
  std::vector<std::size_t> order(gains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
    return std::pair(std::abs(gains[i]), i) < std::pair(std::abs(gains[k]), k);
  });
  double ranks = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double gain = gains[order[i]];
    ranks += gain > 0 ? static_cast<double>(i + 1) : gain < 0 ? -static_cast<double>(i + 1) : 0;
  }
  const auto k = static_cast<double>(gains.size());
  return ranks / std::sqrt(k * (k + 1) * (2 * k + 1) / 6);
}

}  // namespace

Comparison compare(const Explained& x, const Explained& y) {
  if (x.motions.all.empty() || y.motions.all.empty()) return {};
  // below the noise of the better one there is nothing to win
  const double floor = std::min(x.fit.typical, y.fit.typical);
  const double begin = std::max(x.motions.all.front().time, y.motions.all.front().time);
  const double end = std::min(x.motions.all.back().time, y.motions.all.back().time);
  const std::size_t blocks = std::min(x.motions.blocks, y.motions.blocks);
  const BlockMeans of_x = block_means(x, floor, begin, end, blocks);
  const BlockMeans of_y = block_means(y, floor, begin, end, blocks);
  std::vector<double> gains;
  double sum = 0, count = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    if (of_x.counts[block] == 0 || of_y.counts[block] == 0) continue;
    gains.push_back(of_x.logs[block] - of_y.logs[block]);
    sum += gains.back() * of_y.counts[block];
    count += of_y.counts[block];
  }
  if (gains.empty()) return {};
  const auto k = static_cast<double>(gains.size());
  return {sum / count, signed_rank_sigmas(gains), std::sqrt(1.5 * k * (k + 1) / (2 * k + 1)),
          trimmed_mean(x.fit.squares) / std::max(trimmed_mean(y.fit.squares), least_square)};
}

double loss_in_metres(const Explained& x, const Explained& y) {
  if (x.motions.all.size() != y.motions.all.size()) return 0;
  const Pose of_x = to_pose(x.fit.T), of_y = to_pose(y.fit.T);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < x.motions.all.size(); ++i) {
    const double here = residual_at(x.motions.all[i], of_x).translation,
                 there = residual_at(y.motions.all[i], of_y).translation;
    if (!(here > 0 && there > 0)) continue;
    sum += 2 * std::log(there / here);
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace egocal::detail
