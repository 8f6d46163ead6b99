// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "egocal/problem/problem.hpp"

namespace egocal {

/// One setting that could be used: the statistics of a stride, with a balance.
struct Candidate {
  int stride = 1;
  Balance balance;
  std::vector<Statistics> blocks;
};

/// The blocks, neighbours joined until each has at least so many pairs.
std::vector<Statistics> merge_blocks(const std::vector<Statistics>& blocks, std::uint64_t least_pairs);

/// Blocks so long that what neighbours share (motions of so many steps overlap) hardly matters to the
/// jack-knife: four motions, or two where that would leave too few blocks.
std::vector<Statistics> independent_blocks(const std::vector<Statistics>& blocks, int stride);

/// Spread of the answers when each of several consecutive parts of the drive is left out.
struct Spread {
  double rotation = 0;     ///< standard deviation, root of the sum over the observable directions [rad]
  double translation = 0;  ///< [m]
  int directions = 0;      ///< observable ones
};
/// Empty where too few parts of at least two strides' length are there, or nothing is observable.
std::optional<Spread> answer_spread(const Problem& problem, int stride);

/// The candidate with the smallest spread, in rotation and translation together (their product: it has no
/// unit to choose). One that shows more directions beats one that shows fewer. `current` (an index) keeps its
/// place unless another is better by a tenth: settings do not flap. Empty where no candidate has a spread.
struct Selection {
  std::size_t index = 0;
  Spread spread;
};
std::optional<Selection> select_candidate(const Problem& problem, std::span<const Candidate> candidates,
                                          std::optional<std::size_t> current);

}  // namespace egocal
