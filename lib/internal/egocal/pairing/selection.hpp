// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
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

/// Tuning of the choice between settings. Study: tests/bench/accuracy_benchmark.cpp, docs/accuracy.md.
struct SelectionOptions {
  /// Parts of the drive that the jack-knife omits: at least this many, each at least two motions long,
  /// or else neighbouring parts share motions and their spread says too little.
  std::size_t least_parts = 8;
  /// Spreads below these are rounding, all alike [rad, m]: the logarithm of one is a draw.
  double least_rotation = 1e-9, least_translation = 1e-8;
  /// Errors that the spread does not show (stamps, interpolation) weigh less in longer motions: taken off the
  /// logarithm of the spread for each doubling of the stride. Not where there is no noise: single steps are
  /// then as good, and show outliers one by one.
  double longer = 0.075;
  /// Another setting replaces the one in force where its spreads are smaller by this part: settings do not
  /// flap.
  double hysteresis = 0.1;
  /// A setting is not taken where the answer of longer motions differs from its own by this many of their
  /// standard deviations: what is wrong with every step in the same way (streams interpolated across fast
  /// turns) no spread shows, but it fades as motions grow. Four: of 36 comparisons a drive, one in 400
  /// drives.
  double contradicts = 4;
  /// Translations that weigh more than this many times as much as rotations, by their squared residuals, with
  /// the smallest of the given balances have smaller ones tried as well (a tenth, a hundredth, ...), until
  /// rotations weigh this many times as much. An aircraft at 100 m/s errs by 20 m and 2 deg in four seconds:
  /// the balance is 3e-6, and with 0.001 its answer was turned about the direction of travel by 150 deg.
  double imbalance = 10;
  /// Smaller balances are tried only where translations err by more than this, root mean square [m]: else
  /// poses without noise but with outliers lose (benchmark, four outliers: 12 instead of 10 mm).
  double least_error = 1;
  double least_balance = 1e-9;  ///< smaller ones are not tried: a cost in metres keeps its digits [1/m^2]
};

/// The blocks, neighbours joined until each has at least `least_pairs` pairs.
std::vector<Statistics> merge_blocks(const std::vector<Statistics>& blocks, std::uint64_t least_pairs);

/// Blocks so long that what neighbours share (motions of `stride` steps overlap) hardly matters to the
/// jack-knife: four motions, or two where that would leave too few blocks.
std::vector<Statistics> independent_blocks(const std::vector<Statistics>& blocks, int stride,
                                           const SelectionOptions& options = {});

/// Spread of the answers when each of several consecutive parts of the drive is omitted.
struct Spread {
  double rotation = 0;     ///< standard deviation, root of the sum over the observable directions [rad]
  double translation = 0;  ///< [m]
  int directions = 0;      ///< observable ones
};

/// The candidate with the smallest spread, in rotation and translation together (their product: it has no
/// unit to choose), of those that no longer motions contradict (SelectionOptions::contradicts). One that
/// shows more directions beats one that shows fewer. `current` (an index) stays
/// in force unless another is clearly better (SelectionOptions::hysteresis). Empty where no candidate has a
/// spread.
struct Selection {
  std::size_t index = 0;
  Spread spread;
};
std::optional<Selection> select_candidate(const Problem& problem, std::span<const Candidate> candidates,
                                          std::optional<std::size_t> current,
                                          const SelectionOptions& options = {});

/// The kept motions of one stride.
struct MotionsOfStride {
  int stride = 1;
  std::vector<Statistics> blocks;
};

struct Setting {
  int stride = 1;
  Balance balance;
};

/// The best of every stride with every balance of rotation 1 and a translation of `balances` [1/m^2], or with
/// `fixed` alone. Where translations outweigh rotations with the best (SelectionOptions::imbalance; not in
/// planar mode), smaller balances are tried as well. `current` and what is returned as in select_candidate.
struct SelectedSetting {
  Setting setting;
  Spread spread;
  std::size_t tried = 0;  ///< settings
};
std::optional<SelectedSetting> select_setting(const Problem& problem,
                                              std::span<const MotionsOfStride> strides,
                                              std::span<const double> balances,
                                              const std::optional<Balance>& fixed,
                                              const std::optional<Setting>& current,
                                              const SelectionOptions& options = {});

}  // namespace egocal
