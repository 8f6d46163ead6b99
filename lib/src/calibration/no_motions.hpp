// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/pairing/outcome.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// Why two streams have no motion in common, with what may cure it; {a}, {b} and {solve} are marked
/// (finding_words.hpp).
std::string no_motions_in_words(const Trajectory& a, const Trajectory& b, const PairingCounts& counts,
                                double max_gap);

}  // namespace egocal::detail
