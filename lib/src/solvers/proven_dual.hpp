// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "certificate/assess.hpp"
#include "egocal/solvers/global.hpp"

namespace egocal::detail {

struct ProvenSolution {
  Solution solution;
  /// The bound in units of length_scale(Q); empty where the answer is not proven, or by another proof.
  std::optional<ProvenBound> proven;
};

/// solve_dual(), with the bound that it proved on its way.
ProvenSolution solve_dual_with_proof(const Matrix8d& Q);

}  // namespace egocal::detail
