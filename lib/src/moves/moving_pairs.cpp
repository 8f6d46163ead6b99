// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "moves/moving_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace egocal::detail {

namespace {

/// Root mean squares of one stream's motions.
struct Typical {
  double turn = 0, way = 0;
};

Typical typical(std::span<const MotionPair> pairs, DualQuaternion MotionPair::*side) {
  double turns = 0, ways = 0;
  for (const MotionPair& pair : pairs) {
    const double turn = rotation_angle(pair.*side), way = translation_length(pair.*side);
    turns += turn * turn;
    ways += way * way;
  }
  const auto count = static_cast<double>(pairs.size());
  return {std::sqrt(turns / count), std::sqrt(ways / count)};
}

bool moves(const DualQuaternion& motion, const Typical& typical, double least) {
  return rotation_angle(motion) > least * typical.turn || translation_length(motion) > least * typical.way;
}

}  // namespace

std::span<const MotionPair> moving_pairs(std::span<const MotionPair> pairs, double least_motion,
                                         std::vector<MotionPair>& kept) {
  const Typical a = typical(pairs, &MotionPair::a), b = typical(pairs, &MotionPair::b);
  const auto moving = [&](const MotionPair& pair) {
    return moves(pair.a, a, least_motion) && moves(pair.b, b, least_motion);
  };
  const auto count = std::count_if(pairs.begin(), pairs.end(), moving);
  if (static_cast<std::size_t>(count) == pairs.size()) return pairs;
  kept.clear();
  kept.reserve(static_cast<std::size_t>(count));
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(kept), moving);
  return kept;
}

}  // namespace egocal::detail
