// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "moves/linear_blocks.hpp"

namespace egocal::detail {

/// The best division of consecutive blocks into two parts with an extrinsic each, and its evidence
/// (docs/moves.md, "The test").
struct ChangeTest {
  std::size_t split = 0;        ///< index of the first block after it; 0: none could be tested
  double false_alarm = 1;       ///< chance of such evidence at any split where nothing changes
  double correlation = 1;       ///< variance of sums of neighbouring blocks against independent ones, >= 1
  Parameters change;            ///< after minus before
  ParameterMatrix covariance;   ///< of the change
  bool even = false;            ///< an even change explains the blocks better than one division or two
  Parameters begin, end;        ///< of the even change: offsets from the common optimum
  double even_false_alarm = 1;  ///< chance of such evidence for an even change where nothing changes
  ParameterMatrix even_covariance;  ///< of end - begin
};

ChangeTest test_change(std::span<const LinearBlock> blocks, std::size_t least_side,
                       const ChangeTestOptions& options);

/// The evidence of a change at a place that was not searched for.
struct ChangeAt {
  double chance = 1;       ///< of such evidence where nothing changes
  double correlation = 1;  ///< as of ChangeTest
};

/// Evidence of a change within block `split` - 1, which may belong to either side: the side that shows more
/// counts, as two trials. least_side: least number of blocks on each side.
ChangeAt test_change_at(std::span<const LinearBlock> blocks, std::size_t split, std::size_t least_side,
                        const ChangeTestOptions& options);
/// Chance of at least this evidence of an even change if nothing changes.
double chance_of_even_change(std::span<const LinearBlock> blocks, const ChangeTestOptions& options);

}  // namespace egocal::detail
