// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/cost.hpp"

namespace egocal {

/// Sufficient statistics of a drive whose sensor a measures translations in an unknown unit: with the scale s
/// that multiplies them, the sum of eta M_d(s)'M_d(s) over the dual rows M_d(s) of (14) is
///
///     [ (square_b + s^2 square_a) I + s cross     coupling_b + s coupling_a ]
///     [              its transpose                          rotation        ]
///
/// for every s. 54 numbers, additive like Statistics, plain sums in the order of the calls.
struct ScaleStatistics {
  using Block = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;  ///< one layout whatever the compile flags

  Block rotation = Block::Zero();    ///< sum of eta E_r'E_r, the D of (16)
  Block coupling_a = Block::Zero();  ///< sum of -eta L(a_d)'E_r [units of a]
  Block coupling_b = Block::Zero();  ///< sum of eta R(b_d)'E_r [m]
  Block cross = Block::Zero();       ///< sum of -eta (R(b_d)'L(a_d) + L(a_d)'R(b_d)) [m units of a]
  double square_a = 0;               ///< sum of eta |a_d|^2 [units of a, squared]
  double square_b = 0;               ///< sum of eta |b_d|^2 [m^2]
  double weight = 0;                 ///< sum of eta
  std::uint64_t count = 0;           ///< pairs

  void add(const DualQuaternion& a, const DualQuaternion& b, double eta = 1);
  void add(const MotionPair& pair) { add(pair.a, pair.b, pair.eta); }
  ScaleStatistics& operator+=(const ScaleStatistics& other);
  ScaleStatistics& operator-=(const ScaleStatistics& other);
};

ScaleStatistics sum_blocks(std::span<const ScaleStatistics> blocks);

/// The same motions with the scale multiplying the translations of b instead. The extrinsic is then in the
/// units of a.
ScaleStatistics with_scale_on_b(const ScaleStatistics& statistics);

/// The ordinary statistics of the drive at a known scale.
Statistics at_scale(const ScaleStatistics& statistics, double scale);

/// The pairs in at most `blocks` consecutive blocks of equal length, at least `least_pairs` pairs each.
std::vector<ScaleStatistics> scale_blocks(std::span<const MotionPair> pairs, std::size_t blocks = 32,
                                          std::size_t least_pairs = 4);

/// The trajectory with its translations multiplied by the scale.
Trajectory scaled(const Trajectory& trajectory, double scale);
/// The motion with its translation multiplied by the scale.
DualQuaternion scaled(const DualQuaternion& motion, double scale);

}  // namespace egocal
