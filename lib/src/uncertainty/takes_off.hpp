// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/problem/cost.hpp"

namespace egocal::detail {

/// Blocks need not be disjoint: then a last one with a negative weight takes off what is in two of them. It
/// is no part of the drive to omit.
inline bool takes_off(const Statistics& block) {
  return block.weight < 0;
}

}  // namespace egocal::detail
