// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "moves/found_change.hpp"

namespace egocal::detail {

/// First pair after a change, motion by motion, with the answers of both sides.
std::size_t placed(const TestedDrive& drive, const FoundChange& found);
/// Moves a change there, where that is within its stretch.
void move_to_place(const TestedDrive& drive, FoundChange& found);

/// The move of a change: its place and the extrinsics before and after. Empty where a large turn is not
/// credible.
std::optional<Move> described(const TestedDrive& drive, const FoundChange& found);

}  // namespace egocal::detail
