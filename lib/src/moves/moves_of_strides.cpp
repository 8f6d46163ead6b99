// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "egocal/microseconds.hpp"
#include "egocal/moves/find_moves.hpp"
#include "egocal/statistics/median.hpp"
#include "moves/linear_blocks.hpp"
#include "moves/moving_pairs.hpp"

namespace egocal {

namespace {

using Pairs = std::span<const MotionPair>;

/// The motions between the moves before and after number k; other motions would count as noise. Times of
/// moves are counted from origin_us.
Pairs between_neighbours(Pairs pairs, std::span<const Move> moves, std::size_t k, std::int64_t origin_us) {
  const auto at = [&](const Move& move) { return origin_us + to_microseconds(move.time); };
  std::size_t from = 0, to = pairs.size();
  if (k > 0 && moves[k - 1].kind == MoveKind::bump)
    while (from < to && pairs[from].begin_us < at(moves[k - 1])) ++from;
  if (k + 1 < moves.size())
    while (to > from && pairs[to - 1].end_us > at(moves[k + 1])) --to;
  return pairs.subspan(from, to - from);
}

/// Whether these motions show the move too; false only where they were tested and do not.
bool shown_by(Pairs pairs, const Problem& problem, const Move& move, std::int64_t origin_us,
              const MovesOptions& options) {
  const std::int64_t time_us = origin_us + to_microseconds(move.time);
  const std::optional<double> chance = chance_of_move(pairs, problem, move.kind, time_us, options);
  return !chance || *chance <= options.confirmation;
}

/// Noise of the rotations as a part of how far the motions turn, root mean squares without the tails.
double noise_of_rotations(Pairs pairs, const Problem& problem, const MovesOptions& options) {
  std::vector<MotionPair> kept;
  const Pairs moving = detail::moving_pairs(pairs, options.least_motion, kept);
  if (moving.size() < 2) return 0;
  const DualQuaternion q =
      detail::gated_blocks(moving, detail::weighted_by_noise(moving, problem, options.test), 1, options.test)
          .q;
  std::vector<double> noise;
  double turns = 0;
  for (const MotionPair& pair : moving) {
    noise.push_back(detail::pair_residual(pair, q, {1, 0}));  // of half angles
    turns += std::pow(0.5 * rotation_angle(pair.a), 2);
  }
  const auto count = static_cast<double>(noise.size());
  return turns > 0 ? std::sqrt(detail::median(std::move(noise)) / (turns / count)) : 0;
}

}  // namespace

MovesResult find_moves_of_strides(std::span<const std::vector<MotionPair>> strides, const Problem& problem,
                                  const MovesOptions& given) {
  MovesOptions options = given;
  std::size_t shortest = 0;
  while (shortest + 1 < strides.size() &&
         noise_of_rotations(strides[shortest], problem, options) > options.most_noise)
    ++shortest;
  options.false_alarms /= static_cast<double>(std::max<std::size_t>(1, strides.size() - shortest));
  MovesResult best;
  best.stride = shortest;
  double least = 1;
  std::vector<double> chances;
  for (std::size_t i = shortest; i < strides.size(); ++i) {
    MovesResult result = find_moves(strides[i], problem, options);
    if (result.tested) chances.push_back(static_cast<double>(strides.size() - shortest) * result.chance);
    double chance = 1;
    for (const Move& move : result.moves) chance = std::min(chance, move.false_alarm);
    const bool first = !best.tested && result.tested;
    if (!first && !(chance < least)) continue;
    least = chance;
    best = std::move(result);
    best.stride = i;
  }
  // a moved mount shows in motions of every length; an error of one length only is one of an odometry
  std::vector<Move> confirmed;
  for (std::size_t k = 0; k < best.moves.size(); ++k) {
    bool shown = true;
    for (std::size_t i = 0; i < strides.size() && shown; ++i)
      shown = i == best.stride ||
              shown_by(between_neighbours(strides[i], best.moves, k, strides[best.stride].front().begin_us),
                       problem, best.moves[k], strides[best.stride].front().begin_us, given);
    if (shown) confirmed.push_back(best.moves[k]);
  }
  best.moves = std::move(confirmed);
  std::sort(chances.begin(), chances.end());
  best.chance = chances.empty() ? 1 : std::min(1.0, chances[std::min<std::size_t>(1, chances.size() - 1)]);
  return best;
}

}  // namespace egocal
