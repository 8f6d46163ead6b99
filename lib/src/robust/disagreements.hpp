// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/robust/consensus.hpp"
#include "motions/motions_to_one.hpp"

namespace egocal::detail {

/// The same bits as disagreement() of each of the motions, with an agreement for each. Of motions that are
/// not plain: unset. in_pairs: as on processors without wide vectors, for tests.
std::array<double, MotionsToOne::count> disagreements(
    const MotionsToOne& motions, const std::array<const Agreement*, MotionsToOne::count>& agreements,
    const Balance& balance, const ConsensusOptions& options, bool in_pairs = false);

}  // namespace egocal::detail
