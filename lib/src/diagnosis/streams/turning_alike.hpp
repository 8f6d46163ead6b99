// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whether two streams turn as one body does, and the findings that say that they do not, or hardly turn.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/options.hpp"
#include "egocal/diagnosis/verdict.hpp"
#include "egocal/pairing/outcome.hpp"

namespace egocal::detail {

/// Turning of two unrelated streams correlates by chance only; that of one body is the same. Of this part of
/// the motions: those that turn most alike.
double turning_correlation(const Motions& motions, double part = 1);

Finding unrelated(double correlation);
Finding too_little_motion(std::size_t motions, const DiagnosisOptions& options);
/// Names the longest gap in the findings of too little motion, where it rejected more than half of the poses:
/// a longer drive of streams that are slower has as few motions.
void name_longest_gap(const PairingCounts& counts, std::vector<Finding>& findings);
Finding turning_in_noise(double correlation);

}  // namespace egocal::detail
