// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which samples agree on one hand-eye pose.
#pragma once

#include <vector>

#include "egocal/samples/calibrate_samples.hpp"
#include "samples/sample_fit.hpp"

namespace egocal::detail {

/// Samples that agree, ascending, and their fit.
struct AgreeingSamples {
  std::vector<std::size_t> chosen;
  SampleFit fit;
};

/// Least trimmed squares over triples of samples, then samples are taken in again, best first, as long as
/// noise explains them (F test of what one more adds to the cost). All samples where they are too few to
/// judge.
AgreeingSamples find_agreeing(const SampleSet& set, const SampleOptions& options);

}  // namespace egocal::detail
