// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "moves/switching.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "egocal/microseconds.hpp"
#include "egocal/statistics/median.hpp"
#include "linear_algebra/small_factor.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "moves/division.hpp"
#include "moves/moving_pairs.hpp"
#include "problem/tangent.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

using Places = std::array<Parameters, 2>;

double squared_residual(const LinearBlock& block, const Parameters& x) {
  return (block.inverse_root * (block.g + block.H * x)).squaredNorm();
}

/// M = inv(L) M for a lower triangle L.
void solve_below(const ParameterMatrix& L, ParameterMatrix& M) {
  for (Eigen::Index column = 0; column < M.cols(); ++column)
    for (Eigen::Index i = 0; i < L.rows(); ++i) {
      for (Eigen::Index k = 0; k < i; ++k) M(i, column) -= L(i, k) * M(k, column);
      M(i, column) /= L(i, i);
    }
}

/// The v with the largest v'Gv of those with v'Nv = 1; both symmetric, N positive definite. By loops: Eigen's
/// solver of this took half of this file's compilation.
Parameters largest_direction(ParameterMatrix G, const ParameterMatrix& N) {
  const Eigen::Index n = N.rows();
  ParameterMatrix L = ParameterMatrix::Zero(n, n);  // L L' = N
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i) {
      double left = N(i, j);
      for (Eigen::Index k = 0; k < j; ++k) left -= L(i, k) * L(j, k);
      L(i, j) = i == j ? std::sqrt(left) : left / L(j, j);
    }
  solve_below(L, G);
  G.transposeInPlace();
  solve_below(L, G);
  Parameters v = symmetric_eigen<Eigen::Dynamic>(G).vectors.rightCols<1>();
  for (Eigen::Index i = n - 1; i >= 0; --i) {  // v = inv(L') v
    for (Eigen::Index k = i + 1; k < n; ++k) v[i] -= L(k, i) * v[k];
    v[i] /= L(i, i);
  }
  return v;
}

/// Divides the blocks by the sign of their gradients along the direction in which these differ most from
/// their noise.
std::vector<bool> first_sides(Blocks blocks) {
  ParameterMatrix gradients = zero_matrix(blocks), noise = gradients;
  for (const LinearBlock& block : blocks) {
    gradients += block.g * block.g.transpose();
    noise += block.root * block.root;
  }
  noise.diagonal().array() += 1e-12 * noise.trace();
  const Parameters direction = largest_direction(gradients, noise);
  std::vector<bool> sides;
  for (const LinearBlock& block : blocks) sides.push_back(direction.dot(block.g) > 0);
  return sides;
}

Places optima(Blocks blocks, const std::vector<bool>& sides, const ChangeTestOptions& options) {
  const ParameterMatrix borrowed = options.borrowed_curvature * curvature(blocks);
  Places places;
  for (const bool side : {false, true}) {
    ParameterMatrix H = borrowed;
    Parameters g = zero_vector(blocks);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      if (sides[k] != side) continue;
      H += blocks[k].H;
      g += blocks[k].g;
    }
    places[side ? 1 : 0] = -SmallFactor(H).solve(g);
  }
  return places;
}

struct TwoPlaces {
  std::vector<bool> sides;
  Places places;
  double left = 1;
};

TwoPlaces two_places(Blocks blocks, const SwitchingOptions& options) {
  TwoPlaces two;
  two.sides = first_sides(blocks);
  for (int round = 0; round < options.rounds; ++round) {
    two.places = optima(blocks, two.sides, options.test);
    std::vector<bool> sides;
    for (const LinearBlock& block : blocks)
      sides.push_back(squared_residual(block, two.places[1]) < squared_residual(block, two.places[0]));
    if (sides == two.sides) break;
    two.sides = std::move(sides);
  }
  Parameters g = zero_vector(blocks);
  for (const LinearBlock& block : blocks) g += block.g;
  const Parameters one = -SmallFactor(curvature(blocks)).solve(g);
  std::vector<double> squares;
  for (const LinearBlock& block : blocks) squares.push_back(squared_residual(block, one));
  const double most = options.longest_square * median(squares);
  double of_one = 0, of_two = 0;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    of_one += std::min(squares[k], most);
    of_two += std::min(squared_residual(blocks[k], two.places[two.sides[k] ? 1 : 0]), most);
  }
  two.left = of_one > 0 ? of_two / of_one : 1;
  return two;
}

/// Gives each block the side of most of its neighbours and itself. A block in which the mount changes its
/// place, or one that shows little, may have either side.
std::vector<bool> without_single_ones(const std::vector<bool>& sides) {
  std::vector<bool> smooth = sides;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const bool before = sides[k > 0 ? k - 1 : 1], after = sides[k + 1 < sides.size() ? k + 1 : k - 1];
    if (before == after) smooth[k] = before;
  }
  return smooth;
}

/// The switching with this number of blocks.
std::optional<Switching> switching_of(std::span<const MotionPair> pairs, const Problem& problem,
                                      std::size_t count, const SwitchingOptions& options) {
  const Linearised all = linearise(pairs, problem, count, options.test);
  if (all.blocks.empty()) return std::nullopt;
  const TwoPlaces two = two_places(all.blocks, options);
  const auto second = static_cast<std::size_t>(std::count(two.sides.begin(), two.sides.end(), true));
  const auto least = static_cast<std::size_t>(options.least_part * static_cast<double>(count));
  if (!(two.left <= options.most_left) || std::min(second, count - second) < least) return std::nullopt;
  Switching result;
  result.left = two.left;
  const std::vector<bool> sides = without_single_ones(two.sides);
  for (std::size_t k = 1; k < count; ++k) {
    if (sides[k] == sides[k - 1]) continue;
    if (result.switches++ == 0)
      result.time = to_seconds(pairs[all.begin[k]].begin_us - pairs.front().begin_us);
  }
  if (result.switches < options.least_switches) return std::nullopt;
  const DualQuaternion q = in_units_of(1 / all.length, all.q);
  const auto moved = [&](Vector6d x) {
    x.head<3>() *= all.length;
    return canonical_sign(frame_a_moved(q, x));
  };
  const std::size_t begin = sides.front() ? 1 : 0;
  result.first = moved(two.places[begin]);
  result.second = moved(two.places[1 - begin]);
  return result;
}

}  // namespace

std::optional<Switching> find_switching(std::span<const MotionPair> pairs, const Problem& problem,
                                        const SwitchingOptions& options) {
  if (problem.mode == Mode::planar) return std::nullopt;
  std::vector<MotionPair> kept;
  pairs = moving_pairs(pairs, MovesOptions{}.least_motion, kept);
  if (pairs.size() < options.least_blocks * options.block_pairs) return std::nullopt;
  const Problem weighted = weighted_by_noise(pairs, problem, options.test);
  const double seconds = to_seconds(pairs.back().end_us - pairs.front().begin_us);
  const std::size_t most = std::min(options.most_blocks, pairs.size() / options.block_pairs);
  std::optional<Switching> best;
  for (double block = options.shortest_block; block <= options.longest_block; block *= 2) {
    const std::size_t count = std::min(most, static_cast<std::size_t>(seconds / block));
    if (count < options.least_blocks) break;
    std::optional<Switching> here = switching_of(pairs, weighted, count, options);
    if (here && (!best || here->left < best->left)) best = std::move(here);
  }
  return best;
}

}  // namespace egocal::detail
