// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A part of the drive whose extrinsic differs from that before and after it: a mount that moved and fell
// back.
#pragma once

#include "moves/division.hpp"

namespace egocal::detail {

/// The part of consecutive blocks that differs most from the others, and its evidence (docs/moves.md,
/// "Falling back").
struct SegmentTest {
  Part part;                    ///< none where `to` is 0
  double chance = 1;            ///< of such evidence in any part where nothing changes
  double chance_of_halves = 1;  ///< the larger one: of what each half of it shows, at its place
  double chance_of_rest = 1;    ///< of what tells the blocks after it from those before it
  /// How far the parts before and after differ, as a part of the change; in lengths by the covariance of the
  /// change.
  double rest_by_change = 0;
  double correlation = 1;      ///< as of ChangeTest
  Parameters change;           ///< of the part from the others
  ParameterMatrix covariance;  ///< of the change
};

/// Tests parts of at least `least_part` blocks with at least `least_side` blocks on both sides.
SegmentTest test_segment(Blocks blocks, std::size_t least_side, std::size_t least_part,
                         const ChangeTestOptions& options);

}  // namespace egocal::detail
