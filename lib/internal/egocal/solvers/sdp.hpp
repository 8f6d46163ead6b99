// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/solvers/global.hpp"

namespace egocal {

struct SdpOptions {
  double relative_gap = 1e-14;  ///< stop when the barrier's gap is below this part of trace(Q)
  int max_iterations = 200;
};

/// The global minimum of (18) by the paper's semidefinite programme (22): an interior-point method on the
/// linear matrix inequality Z(lambda) >= 0, then (29) to (31). The reference that solve_dual is tested
/// against.
Solution solve_sdp(const Matrix8d& Q, const SdpOptions& options = {});

}  // namespace egocal
