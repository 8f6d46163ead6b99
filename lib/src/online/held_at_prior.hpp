// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "egocal/uncertainty/observability.hpp"

namespace egocal::detail {

struct HeldCost {
  Matrix8d Q;            ///< a cost matrix as (16), with terms that hold the hidden directions
  DualQuaternion start;  ///< the minimiser, moved along them to the prior
};

/// Noise gives the cost a slope along directions that no motion shows, and its minimum a place there that
/// means nothing. To Q are added squares c (p'q)^2 that are zero where the answer has the prior's height
/// (or angle) along each hidden direction. They are quadratic in q, so the relaxation of (18) stays tight,
/// and the certificate is about this cost. hidden: hidden_directions() at the minimiser of Q. Empty where the
/// minimiser is at the prior already.
std::optional<HeldCost> held_at_prior(const Matrix8d& Q, const DualQuaternion& minimiser,
                                      const DualQuaternion& prior, const DirectionBasis& hidden);

}  // namespace egocal::detail
