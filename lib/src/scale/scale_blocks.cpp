// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "scale/scale_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/distributions.hpp"

namespace egocal::detail {

double estimate(std::span<const ScaleSample> samples) {
  double square = 0, product = 0;
  for (const ScaleSample& sample : samples) {
    square += sample.square;
    product += sample.product;
  }
  return square > 0 && product > 0 ? product / square : 0;
}

std::vector<ScaleBlock> blocks_of(std::span<const ScaleSample> samples, std::size_t count) {
  double whole = 0;
  for (const ScaleSample& sample : samples) whole += sample.square;
  std::vector<ScaleBlock> blocks;
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

BlockFit fit_steps(std::span<const ScaleBlock> blocks, const std::vector<std::size_t>& splits) {
  BlockFit fit;
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

BlockFit fit_line(std::span<const ScaleBlock> blocks) {
  double w = 0, t = 0, y = 0, tt = 0, ty = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const double x = blocks[i].time, weight = blocks[i].weight;
    w += weight, t += weight * x, y += weight * blocks[i].log_scale;
    tt += weight * x * x, ty += weight * x * blocks[i].log_scale;
  }
  const double slope = (w * ty - t * y) / (w * tt - t * t), offset = (y - slope * t) / w;
  BlockFit fit;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    fit.values.push_back(offset + slope * blocks[i].time);
    fit.cost += blocks[i].weight * std::pow(blocks[i].log_scale - fit.values.back(), 2);
  }
  return fit;
}

namespace {

/// Weighted squares that a level leaves in consecutive blocks, from sums over the first blocks.
class LevelCost {
 public:
  explicit LevelCost(std::span<const ScaleBlock> blocks) {
    sums_.push_back({});
    for (const ScaleBlock& block : blocks) {
      // squares of differences lose no digits
      const double y = block.log_scale - blocks[0].log_scale;
      const Sums& to = sums_.back();
      sums_.push_back(
          {to.weight + block.weight, to.first + block.weight * y, to.second + block.weight * y * y});
    }
  }

  double operator()(std::size_t from, std::size_t to) const {
    const double first = sums_[to].first - sums_[from].first;
    return sums_[to].second - sums_[from].second - first * first / (sums_[to].weight - sums_[from].weight);
  }

 private:
  struct Sums {
    double weight = 0, first = 0, second = 0;
  };
  std::vector<Sums> sums_;
};

}  // namespace

// Dynamic programming: the best last split for every number of splits and of blocks.
std::vector<std::size_t> best_splits(std::span<const ScaleBlock> blocks, std::size_t count,
                                     std::size_t least_part) {
  const std::size_t size = blocks.size();
  if (least_part == 0 || size < (count + 1) * least_part) return {};
  const LevelCost cost(blocks);
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> least(size + 1, none);  // of the first blocks
  for (std::size_t to = least_part; to <= size; ++to) least[to] = cost(0, to);
  std::vector<std::vector<std::size_t>> last;
  for (std::size_t k = 1; k <= count; ++k) {
    std::vector<double> next(size + 1, none);
    std::vector<std::size_t>& split = last.emplace_back(size + 1);
    for (std::size_t to = (k + 1) * least_part; to <= size; ++to)
      for (std::size_t at = k * least_part; at + least_part <= to; ++at) {
        const double sum = least[at] + cost(at, to);
        if (sum < next[to]) next[to] = sum, split[to] = at;
      }
    least = std::move(next);
  }
  std::vector<std::size_t> splits(count);
  for (std::size_t k = count, to = size; k-- > 0;) to = splits[k] = last[k][to];
  return splits;
}

double correlation_of(std::span<const ScaleBlock> blocks, const BlockFit& fit) {
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

double chance_of(std::span<const ScaleBlock> blocks, const BlockFit& one, const BlockFit& model,
                 double numbers, double places) {
  const double freedom = static_cast<double>(blocks.size()) - 1 - numbers;
  if (!(model.cost > 0)) return one.cost > 0 ? 0 : 1;
  const double f = (one.cost - model.cost) / numbers * freedom / model.cost / correlation_of(blocks, model);
  return std::min(1.0, places * f_exceeded(f, numbers, freedom));
}

}  // namespace egocal::detail
