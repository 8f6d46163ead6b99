// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/problem/cost.hpp"

namespace egocal::detail {

/// A sum without one of its parts.
inline Statistics without_part(const Statistics& all, const Statistics& part) {
  Statistics rest = all;
  rest.dual_rows -= part.dual_rows;
  rest.weight -= part.weight;
  rest.count -= part.count;
  return rest;
}

}  // namespace egocal::detail
