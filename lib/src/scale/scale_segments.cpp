// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "scale/scale_segments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "scale/scale_blocks.hpp"

namespace egocal::detail {

namespace {

using Samples = std::span<const ScaleSample>;
using Blocks = std::vector<ScaleBlock>;
using Splits = std::vector<std::size_t>;

/// At least the number of ways to put this many splits between the blocks.
double places_of(std::size_t splits, std::size_t blocks) {
  double places = 1;
  for (std::size_t k = 0; k < splits; ++k)
    places *= static_cast<double>(blocks - k) / static_cast<double>(k + 1);
  return places;
}

class Search {
 public:
  Search(Samples samples, const ScaleCourseOptions& options, bool whole_only)
      : samples_(samples), options_(options), whole_only_(whole_only) {}

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
    const Blocks blocks =
        count >= options_.least_blocks ? blocks_of(samples_.subspan(from, to - from), count) : Blocks{};
    if (blocks.size() < options_.least_blocks || found_.size() + 1 >= options_.most_segments)
      return add(from, to, 0);
    const BlockFit one = fit_steps(blocks, {}), slope = fit_line(blocks);
    const double drift = slope.values.back() - slope.values.front();
    if (slope.cost < cost_of_two_steps(blocks) && large(drift) &&
        chance_of(blocks, one, slope, 1, 1) <= 0.5 * options_.false_alarms)
      return add(from, to, drift);
    for (std::size_t changes = 1; changes <= options_.most_at_once; ++changes) {
      const Splits splits = best_splits(blocks, changes, changes == 1 ? 1 : least_part(blocks));
      if (changes > 1 && whole_only_ && to - from < samples_.size()) break;
      if (splits.empty() || !shown(blocks, one, splits)) continue;
      const std::vector<std::size_t> ends = places(blocks, splits, from, to);
      if (ends.empty()) continue;
      for (std::size_t k = 0; k + 1 < ends.size(); ++k) search(ends[k], ends[k + 1]);
      return;
    }
    add(from, to, 0);
  }

  /// Cost of the best step and the best second one. Any two would fit noise on a drift as well as the drift.
  double cost_of_two_steps(const Blocks& blocks) const {
    const std::size_t first = best_splits(blocks, 1, 1).front();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < blocks.size(); ++i)
      if (i != first)
        least = std::min(least, fit_steps(blocks, {std::min(i, first), std::max(i, first)}).cost);
    return least;
  }

  /// Least number of blocks in a part of a stretch with more than one change.
  std::size_t least_part(const Blocks& blocks) const {
    return std::max<std::size_t>(
        2, static_cast<std::size_t>(options_.least_part * static_cast<double>(blocks.size())));
  }

  /// Whether all of these changes are significant together against one scale, and each one between its
  /// neighbours.
  bool shown(std::span<const ScaleBlock> blocks, const BlockFit& one, const Splits& splits) const {
    const BlockFit fit = fit_steps(blocks, splits);
    const std::size_t count = splits.size();
    if (!std::all_of(splits.begin(), splits.end(),
                     [&](std::size_t split) { return large(fit.values[split] - fit.values[split - 1]); }))
      return false;
    const double least = 0.5 * options_.false_alarms * std::pow(options_.of_one_more, count - 1);
    if (!(chance_of(blocks, one, fit, static_cast<double>(count), places_of(count, blocks.size())) <= least))
      return false;
    if (count == 1) return true;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t begin = k > 0 ? splits[k - 1] : 0;
      const std::size_t end = k + 1 < count ? splits[k + 1] : blocks.size();
      const std::span<const ScaleBlock> part = blocks.subspan(begin, end - begin);
      const double chance = chance_of(part, fit_steps(part, {}), fit_steps(part, {splits[k] - begin}), 1,
                                      places_of(1, part.size()));
      if (!(chance <= options_.confirmation)) return false;
    }
    return true;
  }

  /// First sample of each part, and `to`; empty: a part would have none.
  std::vector<std::size_t> places(const Blocks& blocks, const Splits& splits, std::size_t from,
                                  std::size_t to) const {
    const BlockFit fit = fit_steps(blocks, splits);
    std::vector<std::size_t> ends{from};
    for (const std::size_t split : splits) {
      const std::size_t begin = std::max(ends.back(), split > 2 ? from + blocks[split - 2].begin : from);
      const std::size_t end = split + 2 < blocks.size() ? from + blocks[split + 2].begin : to;
      const std::size_t at = place(begin, end, std::exp(fit.values[split - 1]), std::exp(fit.values[split]));
      if (at <= ends.back() || at >= to) return {};
      ends.push_back(at);
    }
    ends.push_back(to);
    return ends;
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
    const Blocks blocks =
        blocks_of(part, std::max<std::size_t>(2, std::min<std::size_t>(32, part.size() / 4)));
    if (blocks.size() > 2) {
      const BlockFit fit = drift != 0 ? fit_line(blocks) : fit_steps(blocks, {});
      double weight = 0;
      for (const ScaleBlock& block : blocks) weight += block.weight;
      segment.stddev = scale * std::sqrt(correlation_of(blocks, fit) * fit.cost /
                                         static_cast<double>(blocks.size() - 1) / weight);
    }
    found_.push_back(segment);
  }

  Samples samples_;
  const ScaleCourseOptions& options_;
  bool whole_only_;
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

std::vector<ScaleSegment> scale_segments(Samples samples, const ScaleCourseOptions& options,
                                         bool whole_only) {
  if (samples.empty()) return {};
  return Search(samples, options, whole_only).run();
}

}  // namespace egocal::detail
