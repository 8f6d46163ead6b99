// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "scale/kept_motions.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

double length(const DualQuaternion& motion) {
  return to_pose(motion).translation.norm();
}

/// a q - q b with the scale on its side.
DualQuaternion difference(const MotionPair& pair, const ScaleSolution& solution, Side side) {
  const DualQuaternion a = canonical_sign(side == Side::a ? scaled(pair.a, solution.scale) : pair.a);
  const DualQuaternion b = canonical_sign(side == Side::b ? scaled(pair.b, solution.scale) : pair.b);
  const DualQuaternion left = a * solution.q, right = solution.q * b;
  return {left.real - right.real, left.dual - right.dual};
}

}  // namespace

std::vector<MotionPair> of_plausible_length(std::span<const MotionPair> pairs) {
  std::vector<double> lengths;
  for (const MotionPair& pair : pairs) lengths.push_back(length(pair.b));
  const double typical = median(lengths);
  std::vector<double> ratios;
  for (const MotionPair& pair : pairs) {
    const double a = length(pair.a), b = length(pair.b);
    if (b > 0.5 * typical && a > 0) ratios.push_back(b / a);
  }
  const double ratio = median(ratios);
  std::vector<MotionPair> kept;
  for (const MotionPair& pair : pairs) {
    const double a = ratio * length(pair.a), b = length(pair.b);
    const double larger = std::max(a, b);
    if (larger < 4 * typical && (larger < 0.5 * typical || (a < 2 * b && b < 2 * a))) kept.push_back(pair);
  }
  return 2 * kept.size() >= pairs.size() ? kept : std::vector<MotionPair>(pairs.begin(), pairs.end());
}

double scale_residual(const MotionPair& pair, const ScaleSolution& solution, Side side) {
  const DualQuaternion off = difference(pair, solution, side);
  return solution.balance.rotation * off.real.squaredNorm() +
         solution.balance.translation * off.dual.squaredNorm();
}

Balance even_balance(std::span<const ScaleStatistics> blocks, Side side) {
  const ScaleStatistics all = sum_blocks(blocks);
  const double square = side == Side::a ? all.square_b : all.square_a;
  const double rotation = 0.25 * all.rotation.trace();
  return {1, square > 0 && rotation > 0 ? rotation / square : 1};
}

std::optional<Balance> noise_balance(std::span<const MotionPair> pairs, const ScaleSolution& solution,
                                     Side side) {
  std::vector<double> rotations, translations;
  for (const MotionPair& pair : pairs) {
    const DualQuaternion off = difference(pair, solution, side);
    rotations.push_back(off.real.squaredNorm());
    translations.push_back(off.dual.squaredNorm());
  }
  const double rotation = median(std::move(rotations)), translation = median(std::move(translations));
  // below this it is the rounding of perfect data that is compared
  constexpr double rounding = 1e-24;
  if (!(rotation > rounding && translation > 0) || !std::isfinite(rotation / translation))
    return std::nullopt;
  return Balance{1, rotation / translation};
}

}  // namespace egocal::detail
