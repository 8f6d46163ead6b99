// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/robust/consensus.hpp"

namespace egocal::detail {

/// The mean squared residual (16) above which a part is an outlier to find_consensus().
double residual_limit(const Statistics& part, const Balance& balance, const ResidualScale& scale,
                      const ConsensusOptions& options = {});

/// Limit of the ratio of the residual of a part of this many motions to the typical one; a larger ratio
/// disagrees.
double excess_limit(std::uint64_t motions, const ConsensusOptions& options);

/// disagreement() of a single motion.
double disagreement(const DualQuaternion& a, const DualQuaternion& b, const Balance& balance,
                    const Agreement& agreement, const ConsensusOptions& options);

}  // namespace egocal::detail
