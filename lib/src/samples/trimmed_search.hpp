// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Least trimmed squares: the samples that agree best, and their fit.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "samples/agreeing.hpp"

namespace egocal::detail {

using Indices = std::vector<std::size_t>;

Indices all_of(const SampleSet& set);

FitSettings settings_of(const SampleOptions& options);

/// Squared residual of sample i, in variances of the noise of the fit.
double in_variances(const SampleSet& set, std::size_t i, const SampleFit& fit);

/// The samples that fit best, ascending, and the quality of their fit.
struct TrimmedFit {
  Indices chosen;
  SampleFit fit;
  double size = 0;  ///< logarithm of the squared residuals of rotation times those of position: has no unit
};

/// The search for the least trimmed fit. set, options and tuning must outlive it.
class TrimmedSearch {
 public:
  TrimmedSearch(const SampleSet& set, const SampleOptions& options, const AgreeingOptions& tuning);

  /// The trimmed fit that starts from the fit of all samples.
  TrimmedFit from_all() const;
  /// The best trimmed fit that starts from triples of samples.
  TrimmedFit best() const;

 private:
  TrimmedFit or_half_turned(TrimmedFit trimmed) const;
  SampleFit first_fit(const Indices& start) const;
  std::vector<Indices> starts() const;
  Indices first_of(const std::vector<std::pair<double, std::size_t>>& order) const;
  TrimmedFit concentrated(SampleFit fit, int steps) const;

  const SampleSet& set_;
  const SampleOptions& options_;
  const AgreeingOptions& tuning_;
  std::size_t kept_ = 0, kept_units_ = 0;
  std::vector<Indices> members_;  ///< of each unit
};

}  // namespace egocal::detail
