// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Bounds of what a competitor at some distance from the answer can save by other outliers. docs/method.md,
// "Outliers".
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "egocal/robust/prove_outliers.hpp"

namespace egocal::detail {

/// One part as the answer over the kept ones sees it.
struct PartLeverage {
  double cost = 0;      ///< q'Qq at the answer
  double limit = 0;     ///< of the part
  double leverage = 0;  ///< eta: (w'Qw) <= eta (w'Zw) for every w with w.real across the answer's; proven
};

/// The answer over the kept parts, and what bounds its competitors: q' = c q + w with c = cos(half the
/// angle), and sqrt(w'Zw) <= y + sqrt(gap) with y^2 = J_S(q') - bound.
struct LeverageBound {
  std::vector<PartLeverage> parts;
  double cost = 0;               ///< truncated cost of the answer, all parts
  double kept_cost = 0;          ///< of the kept parts
  double gap = 0;                ///< kept_cost less its proven lower bound
  double rotation_leverage = 0;  ///< sin^2(half the angle) <= this times w'Zw; proven
};

/// What the leverages prove. Empty: the kept parts do not show every direction, so nothing can be proven.
std::optional<LeverageBound> leverage_bound(std::span<const TruncatedPart> parts,
                                            const std::vector<bool>& outlier);

/// The parts that may be on the other side for some competitor that is as good. Empty: the choice is proven.
std::vector<std::size_t> undecided_parts(const LeverageBound& bound, const std::vector<bool>& outlier,
                                         double distance_step);

}  // namespace egocal::detail
