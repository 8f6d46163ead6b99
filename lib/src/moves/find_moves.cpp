// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/moves/find_moves.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "moves/described_move.hpp"
#include "moves/found_change.hpp"
#include "moves/moving_pairs.hpp"
#include "moves/stretch_test.hpp"

namespace egocal {

namespace {

using detail::FoundChange;
using detail::Shown;
using Pairs = std::span<const MotionPair>;

class Finder {
 public:
  explicit Finder(const detail::TestedDrive& drive) : drive_(drive), test_(drive_) {}

  MovesResult run() {
    MovesResult result;
    if (test_.blocks_in(0, drive_.pairs.size()) < drive_.options.least_blocks) return result;
    result.tested = true;
    search(0, drive_.pairs.size());
    result.chance = std::min(1.0, test_.chance());
    settle();
    join_same();
    for (const FoundChange& found : found_)
      if (std::optional<Move> move = described(drive_, found)) result.moves.push_back(*std::move(move));
    return result;
  }

 private:
  /// Divides the stretch until no part shows a change.
  void search(std::size_t from, std::size_t to) {
    if (found_.size() >= drive_.options.most_moves) return;
    const std::optional<FoundChange> found = test_.best(from, to);
    if (!found) {
      search_two(from, to);
      return;
    }
    found_.push_back(*found);
    if (found->creep) return;
    search(from, found->at);
    search(found->at, to);
  }

  void search_two(std::size_t from, std::size_t to) {
    std::optional<std::array<FoundChange, 2>> two = test_.best_two(from, to);
    if (!two) return;
    auto& [moved, back] = *two;
    // motion by motion, as the rest of a block with the other extrinsic would be a change of its own
    move_to_place(drive_, moved);
    back.from = moved.at;
    move_to_place(drive_, back);
    moved.to = back.at;
    found_.insert(found_.end(), two->begin(), two->end());
    search(from, moved.at);
    search(moved.at, back.at);
    search(back.at, to);
  }

  /// Tests every change again between its neighbours. One that is no longer significant was an echo of them,
  /// or of noise that wanders. Done last, because other changes also make neighbouring blocks alike.
  void settle() {
    std::sort(found_.begin(), found_.end(),
              [](const FoundChange& x, const FoundChange& y) { return x.at < y.at; });
    for (std::size_t i = 0; i < found_.size();) {
      if (found_[i].creep) {
        ++i;
        continue;
      }
      const std::size_t from = i > 0 ? found_[i - 1].at : 0;
      const std::size_t to = i + 1 < found_.size() ? found_[i + 1].at : drive_.pairs.size();
      const bool tested = found_[i].from == from && found_[i].to == to && !found_[i].of_two;
      const std::optional<FoundChange> again = tested ? found_[i] : test_.best(from, to);
      Shown shown = again ? Shown::clearly : Shown::no;
      if (again && test_.blocks_in(from, to) >= drive_.options.least_blocks)
        shown = test_.shown_in_longer_blocks(*again);
      if (shown == Shown::no && test_.blocks_in(from, to) >= drive_.options.least_blocks) {
        found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(i));
        continue;
      }
      if (again && !again->creep) found_[i] = *again;
      found_[i].certain = shown != Shown::perhaps;
      ++i;
    }
  }

  /// Joins two changes that are one change within a block, found from both of its ends.
  void join_same() {
    for (std::size_t i = 0; i + 1 < found_.size();) {
      const FoundChange &x = found_[i], &y = found_[i + 1];
      if (x.creep || y.creep || placed(drive_, x) != placed(drive_, y)) {
        ++i;
        continue;
      }
      const std::optional<FoundChange> again = test_.best(x.from, y.to);
      FoundChange joined = again && !again->creep ? *again : y;
      joined.from = x.from;
      found_[i] = std::move(joined);
      found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    }
  }

  const detail::TestedDrive drive_;
  detail::StretchTest test_;
  std::vector<FoundChange> found_;
};

}  // namespace

MovesResult find_moves(Pairs pairs, const Problem& problem, const MovesOptions& options) {
  std::vector<MotionPair> kept;
  const Pairs moving = detail::moving_pairs(pairs, options.least_motion, kept);
  if (moving.size() < 2) return {};
  return Finder({moving, pairs.front().begin_us, detail::weighted_by_noise(moving, problem, options.test),
                 options, detail::overlap_of(moving)})
      .run();
}

std::optional<double> chance_of_move(Pairs pairs, const Problem& problem, MoveKind kind, std::int64_t time_us,
                                     const MovesOptions& options) {
  std::vector<MotionPair> kept;
  pairs = detail::moving_pairs(pairs, options.least_motion, kept);
  if (pairs.size() < 2) return std::nullopt;
  const std::size_t least = std::max(options.block_pairs, 3 * detail::overlap_of(pairs));
  const std::size_t count = std::min(options.most_blocks, pairs.size() / std::max<std::size_t>(1, least));
  const std::size_t side = detail::least_side(count, options);
  if (count < options.least_blocks || count < 2 * side + 1) return std::nullopt;
  const detail::Linearised stretch =
      detail::linearise(pairs, detail::weighted_by_noise(pairs, problem, options.test), count, options.test);
  if (stretch.blocks.empty()) return std::nullopt;
  if (kind == MoveKind::creep) return detail::chance_of_even_change(stretch.blocks, options.test);
  std::size_t split = 0;
  while (split < count && pairs[stretch.begin[split]].begin_us < time_us) ++split;
  return detail::test_change_at(stretch.blocks, split, side, options.test).chance;
}

}  // namespace egocal
