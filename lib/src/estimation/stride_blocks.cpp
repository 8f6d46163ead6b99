// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/estimation/stride_blocks.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "estimation/block_of.hpp"
#include "problem/motion_square.hpp"

namespace egocal {

namespace {

void add(StrideCell& to, const StrideCell& cell) {
  if (cell.motions.count > 0) to.motions += cell.motions;
  if (cell.rotations.count > 0) to.rotations += cell.rotations;  // few cells have any
}

bool empty(const StrideCell& cell) {
  return cell.motions.count + cell.rotations.count == 0;
}

void add_weighted_motions(Statistics& sum, const Statistics& motions, double rotation, double translation) {
  if (motions.count == 0) return;
  sum.dual_rows += translation * motions.dual_rows;
  sum.dual_rows.topLeftCorner<4, 4>() += rotation * motions.dual_rows.bottomRightCorner<4, 4>();
  sum.weight += translation * motions.weight;
}

void add_weighted_rotations(Statistics& sum, const Statistics& rotations, double rotation,
                            double translation) {
  if (rotations.count == 0) return;
  sum.dual_rows.topLeftCorner<4, 4>() += rotation * rotations.dual_rows.bottomRightCorner<4, 4>();
  sum.weight += translation * rotations.weight;
}

/// Adds to one of the sums by block, which are allocated when first used.
void add(std::vector<Statistics>& sums, std::size_t blocks, std::size_t block, const Statistics& more) {
  if (more.count == 0) return;
  if (sums.empty()) sums.resize(blocks);
  sums[block] += more;
}

/// Length of the first blocks [instants]. In blocks of one instant every motion is in two blocks, however
/// short, so they do not tell what blocks share from errors that last: in drives of 20 and 30 motions
/// intervals were up to 1.8 times too wide (docs/intervals.md, "Blocks of two instants").
constexpr std::uint64_t first_block_length = 2;

/// Least number of blocks between the ends of a motion of `stride` steps.
std::size_t offset(int stride, std::uint64_t block_length) {
  return detail::block_of(static_cast<std::uint64_t>(stride), block_length);
}

}  // namespace

void add_weighted(Statistics& sum, const StrideCell& cell, double rotation, double translation) {
  add_weighted_motions(sum, cell.motions, rotation, translation);
  add_weighted_rotations(sum, cell.rotations, rotation, translation);
}

std::size_t StrideBlocks::block_of(std::uint64_t index) const {
  return detail::block_of(index, state_.block_length);
}

StrideBlocks::StrideBlocks(const std::vector<int>& strides) {
  state_.block_length = first_block_length;
  for (const int stride : strides) state_.strides.push_back({stride, {}, {}});
}

void StrideBlocks::add_instant(std::uint64_t index) {
  while (block_of(index) >= most_blocks) merge();
  const std::size_t block = block_of(index);
  while (state_.instants.size() <= block) {
    state_.instants.push_back(0);
    state_.outlier.push_back(0);
    for (StrideSum& sum : state_.strides) {
      sum.near.reserve(most_blocks);
      sum.far.reserve(most_blocks);
      sum.near.emplace_back();
      sum.far.emplace_back();
    }
  }
  ++state_.instants[block];
}

void StrideBlocks::add(std::size_t stride, std::uint64_t first_index, const detail::MotionSquare& motion,
                       bool rotation_only, double weight) {
  StrideSum& sum = state_.strides[stride];
  const std::size_t first = block_of(first_index);
  const std::size_t last = block_of(first_index + static_cast<std::uint64_t>(sum.stride));
  StrideCell& cell = (last - first == offset(sum.stride, state_.block_length) ? sum.near : sum.far)[first];
  Statistics& sum_of_cell = rotation_only ? cell.rotations : cell.motions;
  motion.add_to(sum_of_cell.dual_rows, weight);
  sum_of_cell.weight += weight;
  ++sum_of_cell.count;
}

/// Merges in place: new vectors after hours of driving would leave holes in the heap.
void StrideBlocks::merge() {
  const std::uint64_t length = 2 * state_.block_length;
  const std::size_t count = (state_.instants.size() + 1) / 2;
  for (std::size_t block = 0; block < state_.instants.size(); ++block) {
    const std::uint64_t instants = std::exchange(state_.instants[block], 0);
    const std::uint8_t outlier = std::exchange(state_.outlier[block], std::uint8_t{0});
    state_.instants[block / 2] += instants;
    if (outlier != 0) state_.outlier[block / 2] = 1;
  }
  state_.instants.resize(count);
  state_.outlier.resize(count);
  for (StrideSum& sum : state_.strides) {
    const std::size_t near = offset(sum.stride, state_.block_length), near_to = offset(sum.stride, length);
    for (std::size_t first = 0; first < sum.near.size(); ++first) {
      const std::array<StrideCell, 2> cells{std::exchange(sum.near[first], {}),
                                            std::exchange(sum.far[first], {})};
      for (std::size_t is_far = 0; is_far < 2; ++is_far) {
        if (empty(cells[is_far])) continue;
        const std::size_t last = first + near + is_far;
        egocal::add((last / 2 - first / 2 == near_to ? sum.near : sum.far)[first / 2], cells[is_far]);
      }
    }
    sum.near.resize(count);
    sum.far.resize(count);
  }
  state_.block_length = length;
}

template <typename Visit>
void StrideBlocks::each_cell(std::size_t stride, const Visit& visit) const {
  const StrideSum& sum = state_.strides[stride];
  const std::size_t near = offset(sum.stride, state_.block_length);
  for (std::size_t first = 0; first < sum.near.size(); ++first) {
    if (state_.outlier[first] != 0) continue;
    for (const bool is_far : {false, true}) {
      const std::size_t last = first + near + (is_far ? 1 : 0);
      const StrideCell& cell = is_far ? sum.far[first] : sum.near[first];
      if (last >= blocks() || empty(cell) || state_.outlier[last] != 0) continue;
      visit(cell, first, last);
    }
  }
}

StrideCell StrideBlocks::total(std::size_t stride) const {
  StrideCell sum;
  each_cell(stride, [&](const StrideCell& cell, std::size_t, std::size_t) { egocal::add(sum, cell); });
  return sum;
}

std::vector<Statistics> StrideBlocks::within(const StrideWeights& weights) const {
  std::vector<Statistics> parts(blocks());
  for (std::size_t i = 0; i < state_.strides.size(); ++i) {
    const StrideSum& sum = state_.strides[i];
    if (offset(sum.stride, state_.block_length) > 0) break;
    for (std::size_t block = 0; block < blocks(); ++block) {
      add_weighted(parts[block], sum.near[block], weights.rotation[i], weights.translation[i]);
      if (i == 0) parts[block].count = sum.near[block].motions.count;
    }
  }
  return parts;
}

TouchingSums::TouchingSums(const StrideBlocks& blocks)
    : strides_(blocks.strides().size()),
      block_length_(blocks.state().block_length),
      instants_(blocks.state().instants),
      left_out_(blocks.state().outlier) {
  for (std::size_t i = 0; i < strides_.size(); ++i) {
    PerStride& sums = strides_[i];
    const auto add_to_block = [&](std::size_t block, const StrideCell& cell) {
      add(sums.motions, blocks.blocks(), block, cell.motions);
      add(sums.rotations, blocks.blocks(), block, cell.rotations);
    };
    blocks.each_cell(i, [&](const StrideCell& cell, std::size_t first, std::size_t last) {
      egocal::add(sums.total, cell);
      add_to_block(first, cell);
      if (first == last) return;
      add_to_block(last, cell);
      egocal::add(sums.shared, cell);
    });
  }
}

WeightedBlocks TouchingSums::weighted(const StrideWeights& weights) const {
  WeightedBlocks::State sums{block_length_, std::vector<Statistics>(instants_.size()), left_out_, {}};
  for (std::size_t i = 0; i < strides_.size(); ++i) {
    const double rotation = weights.rotation[i], translation = weights.translation[i];
    if (!(rotation > 0) && !(translation > 0)) continue;
    const PerStride& stride = strides_[i];
    for (std::size_t block = 0; block < stride.motions.size(); ++block)
      add_weighted_motions(sums.blocks[block], stride.motions[block], rotation, translation);
    for (std::size_t block = 0; block < stride.rotations.size(); ++block)
      add_weighted_rotations(sums.blocks[block], stride.rotations[block], rotation, translation);
    add_weighted(sums.shared, stride.shared, rotation, translation);
  }
  for (std::size_t block = 0; block < sums.blocks.size(); ++block)
    sums.blocks[block].count = instants_[block];
  return WeightedBlocks(std::move(sums));
}

}  // namespace egocal
