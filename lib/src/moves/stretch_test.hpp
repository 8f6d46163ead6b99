// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "moves/found_change.hpp"

namespace egocal::detail {

/// Least number of blocks on each side of a change.
std::size_t least_side(std::size_t blocks, const MovesOptions& options);

enum class Shown { no, perhaps, clearly };

/// Tests stretches [from, to) of the pairs for changes that are significant and large enough to report.
class StretchTest {
 public:
  /// drive: must exist as long as this object.
  explicit StretchTest(const TestedDrive& drive) : drive_(drive) {}

  /// How many blocks a stretch is divided into.
  std::size_t blocks_in(std::size_t from, std::size_t to) const;

  /// The best change.
  std::optional<FoundChange> best(std::size_t from, std::size_t to);

  /// A mount that moved and fell back: both changes, each with its own stretch. One division shows little of
  /// it (docs/moves.md, "Falling back").
  std::optional<std::array<FoundChange, 2>> best_two(std::size_t from, std::size_t to);

  /// Noise that wanders for longer than a block makes neighbouring blocks alike, and the test believes it.
  /// Where it still wanders in the longest blocks, its memory is a guess from few of them.
  Shown shown_in_longer_blocks(const FoundChange& found) const;

  /// Chance of the strongest evidence so far, reported or not.
  double chance() const { return chance_; }

 private:
  /// Chance of a false alarm that is allowed in blocks of this number of pairs.
  double false_alarms(std::size_t block_pairs) const;

  const TestedDrive& drive_;
  double chance_ = 1;
};

}  // namespace egocal::detail
