// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/rig/rig_moves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "egocal/microseconds.hpp"

namespace egocal {

namespace {

struct Seen {
  std::size_t pair = 0;
  Move move;
};

/// What all pairs show, in groups of one time each.
std::vector<std::vector<Seen>> grouped(std::vector<Seen> seen, double same_time) {
  std::stable_sort(seen.begin(), seen.end(),
                   [](const Seen& i, const Seen& k) { return i.move.earliest < k.move.earliest; });
  std::vector<std::vector<Seen>> groups;
  double end = -std::numeric_limits<double>::infinity();
  for (Seen& one : seen) {
    const bool creep = one.move.kind == MoveKind::creep;
    const bool joins = !groups.empty() && groups.back().front().move.kind == one.move.kind &&
                       (creep || one.move.earliest - same_time <= end + same_time);
    if (!joins) groups.emplace_back(), end = one.move.latest;
    end = std::max(end, one.move.latest);
    groups.back().push_back(std::move(one));
  }
  return groups;
}

/// The motions between two times [s] from the first one's begin.
std::span<const MotionPair> part_of(const RigPair& pair, double from, double to) {
  const auto at = [&](double seconds) {
    const double time_us = static_cast<double>(pair.pairs.front().begin_us) + second_us * seconds;
    return std::lower_bound(
        pair.pairs.begin(), pair.pairs.end(), time_us,
        [](const MotionPair& motion, double time) { return static_cast<double>(motion.begin_us) < time; });
  };
  return {at(from), at(to)};
}

/// The sensor whose pairs changed while the others did not: the mean evidence, in decades of chance, of its
/// pairs less that of the other ones.
std::optional<std::size_t> moved_sensor(std::size_t sensors, std::span<const RigPair> pairs,
                                        const std::vector<double>& decades, double least_lead) {
  if (sensors < 3) return std::nullopt;
  std::vector<double> lead;
  for (std::size_t s = 0; s < sensors; ++s) {
    double own = 0, other = 0;
    std::size_t own_count = 0, other_count = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const bool has = pairs[i].a == s || pairs[i].b == s;
      (has ? own : other) += decades[i];
      ++(has ? own_count : other_count);
    }
    if (own_count == 0 || other_count == 0) return std::nullopt;
    lead.push_back(own / static_cast<double>(own_count) - other / static_cast<double>(other_count));
  }
  const auto first = std::max_element(lead.begin(), lead.end());
  std::vector<double> sorted = lead;
  std::sort(sorted.rbegin(), sorted.rend());
  if (!(sorted[0] >= sorted[1] + least_lead)) return std::nullopt;
  return static_cast<std::size_t>(first - lead.begin());
}

}  // namespace

std::vector<RigMove> find_rig_moves(std::size_t sensors, std::span<const RigPair> pairs,
                                    std::span<const ShownMove> shown, const RigMovesOptions& options) {
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto is_here = [i](const ShownMove& move) { return move.pair == i; };
    if (std::none_of(shown.begin(), shown.end(), is_here)) continue;
    for (Move& move : find_moves(pairs[i].pairs, pairs[i].problem, options.moves).moves)
      if (move.certain && std::any_of(shown.begin(), shown.end(), [&](const ShownMove& other) {
            return is_here(other) && move.earliest - options.same_time <= other.time &&
                   other.time <= move.latest + options.same_time;
          }))
        seen.push_back({i, std::move(move)});
  }
  const auto groups = grouped(std::move(seen), options.same_time);
  std::vector<RigMove> result;
  for (const std::vector<Seen>& group : groups) {
    const Seen& best = *std::min_element(group.begin(), group.end(), [](const Seen& i, const Seen& k) {
      return i.move.false_alarm < k.move.false_alarm;
    });
    RigMove& move = result.emplace_back();
    move.kind = best.move.kind;
    move.time = best.move.time;
    move.earliest = best.move.earliest;
    move.latest = best.move.latest;
    move.pair = best.pair;
    move.move = best.move;
  }
  // between its neighbours in time, what does every pair say?
  for (std::size_t k = 0; k < result.size(); ++k) {
    const double from = k > 0 ? result[k - 1].latest : 0;
    const double to =
        k + 1 < result.size() ? result[k + 1].earliest : std::numeric_limits<double>::infinity();
    std::vector<double> decades;
    for (const RigPair& pair : pairs) {
      const auto part = part_of(pair, std::min(from, result[k].time), std::max(to, result[k].time));
      const double chance =
          chance_of_move(part, pair.problem, result[k].kind,
                         pair.pairs.front().begin_us + to_microseconds(result[k].time), options.moves)
              .value_or(1);
      decades.push_back(chance > 0 ? std::min(options.most_decades, -std::log10(chance))
                                   : options.most_decades);
    }
    result[k].sensor = moved_sensor(sensors, pairs, decades, options.least_lead);
  }
  return result;
}

}  // namespace egocal
