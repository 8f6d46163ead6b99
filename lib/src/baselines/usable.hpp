// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "egocal/problem/cost.hpp"

namespace egocal {

/// The pairs with usable numbers, both motions as unit dual quaternions with scalar part >= 0.
inline std::vector<MotionPair> usable_pairs(std::span<const MotionPair> pairs) {
  std::vector<MotionPair> usable;
  usable.reserve(pairs.size());
  for (const MotionPair& pair : pairs) {
    const bool finite =
        pair.a.vec().allFinite() && pair.b.vec().allFinite() && pair.eta > 0 && pair.eta < 1e300;
    if (!finite || !(pair.a.real.norm() > 0) || !(pair.b.real.norm() > 0)) continue;
    MotionPair unit = pair;
    unit.a = canonical_sign(normalized(pair.a));
    unit.b = canonical_sign(normalized(pair.b));
    usable.push_back(unit);
  }
  return usable;
}

}  // namespace egocal
