// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include "egocal/problem/problem.hpp"

namespace egocal::detail {

/// Whether this block is subtracted: blocks may share motions, and then a last block with a negative weight
/// takes off what is in two of them. It is no part of the drive, so it is never omitted.
inline bool takes_off(const Statistics& block) {
  return block.weight < 0;
}

/// How many blocks can be omitted.
inline std::size_t blocks_to_omit(const Problem& problem) {
  return static_cast<std::size_t>(std::count_if(problem.blocks.begin(), problem.blocks.end(),
                                                [](const Statistics& block) { return !takes_off(block); }));
}

}  // namespace egocal::detail
