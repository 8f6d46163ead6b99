// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "samples/trimmed_search.hpp"

namespace egocal::detail {

/// The trimmed fit with all samples that noise explains. They are added best first, and the last fit is
/// exact.
AgreeingSamples with_added_samples(const SampleSet& set, const TrimmedFit& trimmed,
                                   const SampleOptions& options, const AgreeingOptions& tuning);

}  // namespace egocal::detail
