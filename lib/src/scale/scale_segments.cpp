// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "scale/scale_segments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/distributions.hpp"

namespace egocal::detail {

namespace {

using Samples = std::span<const ScaleSample>;

/// The logarithm of the scale of some consecutive motions; 1 / weight is its variance, up to a factor that is
/// common to all.
struct Block {
  double log_scale = 0, weight = 0;
  double time = 0;        ///< where the motions are that show it [us], since the first one
  std::size_t begin = 0;  ///< index of its first sample
};

double estimate(Samples samples) {
  double square = 0, product = 0;
  for (const ScaleSample& sample : samples) {
    square += sample.square;
    product += sample.product;
  }
  return square > 0 && product > 0 ? product / square : 0;
}

/// At most `count`, which all show the scale about equally well, however long a vehicle stands or turns in
/// place meanwhile. Empty where one of them shows no scale.
std::vector<Block> blocks_of(Samples samples, std::size_t count) {
  double whole = 0;
  for (const ScaleSample& sample : samples) whole += sample.square;
  std::vector<Block> blocks;
  double seen = 0;
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    const double enough =
        whole * static_cast<double>(blocks.size() + 1) / static_cast<double>(count) * (1 - 1e-12);
    double square = 0, times = 0;
    for (; end < samples.size() && (end == begin || seen < enough); ++end) {
      seen += samples[end].square;
      square += samples[end].square;
      times += samples[end].square * static_cast<double>(samples[end].begin_us - samples[0].begin_us);
    }
    const double scale = estimate(samples.subspan(begin, end - begin));
    if (!(scale > 0)) return {};
    blocks.push_back({std::log(scale), square * scale * scale, times / square, begin});
  }
  return blocks;
}

/// Weighted least squares of steps and of a straight line over blocks.
struct Fit {
  std::vector<double> values;  ///< of the model, one a block
  double cost = 0;             ///< weighted squares left
};

Fit steps(std::span<const Block> blocks, const std::vector<std::size_t>& splits) {
  Fit fit;
  std::size_t begin = 0;
  for (std::size_t k = 0; k <= splits.size(); ++k) {
    const std::size_t end = k < splits.size() ? splits[k] : blocks.size();
    double weight = 0, sum = 0;
    for (std::size_t i = begin; i < end; ++i)
      weight += blocks[i].weight, sum += blocks[i].weight * blocks[i].log_scale;
    for (std::size_t i = begin; i < end; ++i) {
      fit.values.push_back(sum / weight);
      fit.cost += blocks[i].weight * std::pow(blocks[i].log_scale - sum / weight, 2);
    }
    begin = end;
  }
  return fit;
}

Fit line(std::span<const Block> blocks) {
  double w = 0, t = 0, y = 0, tt = 0, ty = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const double x = blocks[i].time, weight = blocks[i].weight;
    w += weight, t += weight * x, y += weight * blocks[i].log_scale;
    tt += weight * x * x, ty += weight * x * blocks[i].log_scale;
  }
  const double slope = (w * ty - t * y) / (w * tt - t * t), offset = (y - slope * t) / w;
  Fit fit;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    fit.values.push_back(offset + slope * blocks[i].time);
    fit.cost += blocks[i].weight * std::pow(blocks[i].log_scale - fit.values.back(), 2);
  }
  return fit;
}

/// How much more sums of neighbouring residuals vary than those of independent ones would, >= 1.
double correlation_of(std::span<const Block> blocks, const Fit& fit) {
  double largest = 1;
  const std::size_t count = blocks.size();
  for (std::size_t length = 2; 4 * length <= count; length *= 2) {
    double grouped = 0, single = 0;
    for (std::size_t i = 0; i + length <= count; i += length) {
      double sum = 0;
      for (std::size_t k = i; k < i + length; ++k) {
        const double z = std::sqrt(blocks[k].weight) * (blocks[k].log_scale - fit.values[k]);
        sum += z;
        single += z * z;
      }
      grouped += sum * sum;
    }
    if (single > 0) largest = std::max(largest, grouped / single);
  }
  return largest;
}

/// Chance that the model reduces the cost by this much where the scale is one, at one of `places`.
double chance_of(std::span<const Block> blocks, const Fit& one, const Fit& model, double places) {
  const double freedom = static_cast<double>(blocks.size()) - 2;
  if (!(model.cost > 0)) return one.cost > 0 ? 0 : 1;
  const double f = (one.cost - model.cost) * freedom / model.cost / correlation_of(blocks, model);
  return std::min(1.0, places * f_exceeded(f, 1, freedom));
}

class Search {
 public:
  Search(Samples samples, const ScaleCourseOptions& options) : samples_(samples), options_(options) {}

  std::vector<ScaleSegment> run() {
    search(0, samples_.size());
    return std::move(found_);
  }

 private:
  std::size_t blocks_in(std::size_t from, std::size_t to) const {
    return std::min(options_.most_blocks, (to - from) / std::max<std::size_t>(1, options_.least_block));
  }
  bool large(double change) const { return std::abs(change) > std::log1p(options_.least_change); }

  void search(std::size_t from, std::size_t to) {
    const std::size_t count = blocks_in(from, to);
    const std::vector<Block> blocks = count >= options_.least_blocks
                                          ? blocks_of(samples_.subspan(from, to - from), count)
                                          : std::vector<Block>{};
    if (blocks.size() < options_.least_blocks || found_.size() + 1 >= options_.most_segments)
      return add(from, to, 0);
    const Fit one = steps(blocks, {});
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity(), least_two = least;
    for (std::size_t i = 1; i < blocks.size(); ++i) {
      const double cost = steps(blocks, {i}).cost;
      if (cost < least) least = cost, best = i;
    }
    for (std::size_t i = 1; i < blocks.size(); ++i)
      if (i != best)
        least_two = std::min(least_two, steps(blocks, {std::min(i, best), std::max(i, best)}).cost);
    const Fit step = steps(blocks, {best}), slope = line(blocks);
    const double drift = slope.values.back() - slope.values.front();
    if (slope.cost < least_two && large(drift) &&
        chance_of(blocks, one, slope, 1) <= 0.5 * options_.false_alarms)
      return add(from, to, drift);
    const double change = step.values[best] - step.values[best - 1];
    if (!large(change) ||
        !(chance_of(blocks, one, step, static_cast<double>(blocks.size())) <= 0.5 * options_.false_alarms))
      return add(from, to, 0);
    const std::size_t begin = best > 2 ? from + blocks[best - 2].begin : from;
    const std::size_t end = best + 2 < blocks.size() ? from + blocks[best + 2].begin : to;
    const std::size_t at = place(begin, end, std::exp(step.values[best - 1]), std::exp(step.values[best]));
    if (at <= from || at >= to) return add(from, to, 0);
    search(from, at);
    search(at, to);
  }

  /// The first motion that fits the scale after the change better than the one before, in sum.
  std::size_t place(std::size_t begin, std::size_t end, double before, double after) const {
    double sum = 0, least = 0;
    std::size_t best = begin;
    for (std::size_t i = begin; i < end; ++i) {
      const auto cost = [&](double s) { return samples_[i].square * s * s - 2 * samples_[i].product * s; };
      sum += cost(before) - cost(after);
      if (sum < least) least = sum, best = i + 1;
    }
    return best;
  }

  /// drift: of the logarithm, from begin to end.
  void add(std::size_t from, std::size_t to, double drift) {
    const Samples part = samples_.subspan(from, to - from);
    ScaleSegment segment;
    segment.begin_us = part.front().begin_us;
    segment.end_us = part.back().end_us;
    const double scale = estimate(part);
    segment.begin_scale = scale * std::exp(-0.5 * drift);
    segment.end_scale = scale * std::exp(0.5 * drift);
    const std::vector<Block> blocks =
        blocks_of(part, std::max<std::size_t>(2, std::min<std::size_t>(32, part.size() / 4)));
    if (blocks.size() > 2) {
      const Fit fit = drift != 0 ? line(blocks) : steps(blocks, {});
      double weight = 0;
      for (const Block& block : blocks) weight += block.weight;
      segment.stddev = scale * std::sqrt(correlation_of(blocks, fit) * fit.cost /
                                         static_cast<double>(blocks.size() - 1) / weight);
    }
    found_.push_back(segment);
  }

  Samples samples_;
  const ScaleCourseOptions& options_;
  std::vector<ScaleSegment> found_;
};

}  // namespace

ScaleSample scale_sample(const MotionPair& pair, const DualQuaternion& q, Side side) {
  const DualQuaternion a = canonical_sign(pair.a), b = canonical_sign(pair.b);
  // the dual rows of a q - q b, with the scale on its side: s u - w
  const QuaternionVector left = quaternion_product(a.dual, q.real),
                         right = quaternion_product(q.real, b.dual);
  const QuaternionVector lever = quaternion_product(a.real, q.dual) - quaternion_product(q.dual, b.real);
  const QuaternionVector u = side == Side::a ? left : right;
  const QuaternionVector w =
      side == Side::a ? QuaternionVector(right - lever) : QuaternionVector(left + lever);
  return {u.squaredNorm(), u.dot(w), w.squaredNorm(), pair.begin_us, pair.end_us};
}

std::vector<ScaleSegment> scale_segments(Samples samples, const ScaleCourseOptions& options) {
  if (samples.empty()) return {};
  return Search(samples, options).run();
}

}  // namespace egocal::detail
