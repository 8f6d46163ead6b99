// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/robust/consensus.hpp"

namespace egocal::detail {

/// The mean squared residual (16) above which a part is an outlier to find_consensus().
double residual_limit(const Statistics& part, const Balance& balance, const ResidualScale& scale,
                      const ConsensusOptions& options = {});

/// Of the excess of a part of so many motions over the typical residual: above it the part disagrees.
double excess_limit(std::uint64_t motions, const ConsensusOptions& options);

/// disagreement() of a single motion.
double disagreement(const DualQuaternion& a, const DualQuaternion& b, const Balance& balance,
                    const Agreement& agreement, const ConsensusOptions& options);

}  // namespace egocal::detail
