// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "egocal/moves/find_moves.hpp"

namespace egocal {

namespace {

using Pairs = std::span<const MotionPair>;

/// The motions from the move before number k to the one after it: others would pass for noise. Times of moves
/// are counted from origin_us.
Pairs between_neighbours(Pairs pairs, std::span<const Move> moves, std::size_t k, std::int64_t origin_us) {
  const auto at = [&](const Move& move) { return origin_us + static_cast<std::int64_t>(1e6 * move.time); };
  std::size_t from = 0, to = pairs.size();
  if (k > 0 && moves[k - 1].kind == MoveKind::bump)
    while (from < to && pairs[from].begin_us < at(moves[k - 1])) ++from;
  if (k + 1 < moves.size())
    while (to > from && pairs[to - 1].end_us > at(moves[k + 1])) --to;
  return pairs.subspan(from, to - from);
}

/// False: the motions were tested and do not show it.
bool shown_by(Pairs pairs, const Problem& problem, const Move& move, std::int64_t origin_us,
              const MovesOptions& options) {
  const std::int64_t time_us = origin_us + static_cast<std::int64_t>(1e6 * move.time);
  const std::optional<double> chance = chance_of_move(pairs, problem, move.kind, time_us, options);
  return !chance || *chance <= options.confirmation;
}

}  // namespace

MovesResult find_moves_of_strides(std::span<const std::vector<MotionPair>> strides, const Problem& problem,
                                  const MovesOptions& given) {
  MovesOptions options = given;
  options.false_alarms /= static_cast<double>(std::max<std::size_t>(1, strides.size()));
  MovesResult best;
  double least = 1, least_chance = 1;
  for (std::size_t i = 0; i < strides.size(); ++i) {
    MovesResult result = find_moves(strides[i], problem, options);
    least_chance = std::min(least_chance, static_cast<double>(strides.size()) * result.chance);
    double chance = 1;
    for (const Move& move : result.moves) chance = std::min(chance, move.false_alarm);
    const bool first = !best.tested && result.tested;
    if (!first && !(chance < least)) continue;
    least = chance;
    best = std::move(result);
    best.stride = i;
  }
  // a mount that moved shows in motions of every length; errors of one length only are those of an odometry
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
  best.chance = least_chance;
  return best;
}

}  // namespace egocal
