// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "egocal/moves/find_moves.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::detail {

// Six parameters, or three in planar mode; never on the heap.
using Parameters = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using ParameterMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

/// One block of a drive, around the optimum q of the whole: J(q moved by x) = J + 2 g'x + x'Hx. x: dt, then
/// dtheta in sensor a's frame (planar mode: x, y, yaw in plane a's); lengths in `Linearised::length`.
struct LinearBlock {
  Parameters g;
  ParameterMatrix H;
  ParameterMatrix root, inverse_root;  ///< of the covariance of the noise in g, but for a factor
  Matrix8d Q = Matrix8d::Zero();       ///< its cost, with the noise of its own rotations
  double time = 0;                     ///< of its middle, from -1 at the begin of the stretch to 1 at its end
};

struct Linearised {
  std::vector<LinearBlock> blocks;
  std::vector<std::size_t> begin;  ///< index of each block's first pair
  DualQuaternion q;                ///< minimiser of (18) over all blocks (planar mode: T_p), in `length`
  double length = 1;               ///< [m]
};

/// How far a pair is from fitting an extrinsic: |a q - q b|^2, weighted.
double pair_residual(const MotionPair& pair, const DualQuaternion& q, const Balance& balance);

/// The problem with a balance by the inverse variances of both residuals. The balance that the jack-knife
/// chooses on a drive with a moved mount hides the move; and noise in a gradient then has the shape of the
/// curvature, as the test assumes. The given balance where there is no noise.
Problem weighted_by_noise(std::span<const MotionPair> pairs, const Problem& problem,
                          const ChangeTestOptions& options);

/// Pairs that share time with the next ones: how many motions one step overlaps with.
std::size_t overlap_of(std::span<const MotionPair> pairs);

/// Statistics of the pairs without those that fit far worse than their neighbours.
struct Gated {
  std::vector<Statistics> blocks;
  std::vector<std::vector<std::size_t>> kept;  ///< indices of each block's pairs
  DualQuaternion q;                            ///< minimiser (planar mode: T_p)
};
Gated gated_blocks(std::span<const MotionPair> pairs, const Problem& problem, std::size_t blocks,
                   const ChangeTestOptions& options);

/// The motions in linear blocks; no blocks where there is no motion.
Linearised linearise(std::span<const MotionPair> pairs, const Problem& problem, std::size_t blocks,
                     const ChangeTestOptions& options);

}  // namespace egocal::detail
