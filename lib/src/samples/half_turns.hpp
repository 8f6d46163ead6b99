// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Half turns leave two things open: the signs of their quaternions, and, as they commute with each other,
// whether X or X times one of them is meant. Positions decide.
#pragma once

#include <span>
#include <vector>

#include "samples/sample_fit.hpp"

namespace egocal::detail {

/// Study: tests/lib/test_samples_half_turns.cpp.
struct HalfTurnOptions {
  /// A motion is nearly half a turn where its quaternion's scalar is below this: 157 degrees and more. Far
  /// beyond the noise, which decides the sign at 0.
  double nearly = 0.2;
  double least_apart = 0.7;  ///< cosine between axes below which they are two
  /// Another answer is open where its rotations leave squared residuals of up to this many times those of the
  /// one found [-]; right ones differ by chance alone, wrong ones by a hundred times and more.
  double as_good = 10;
  std::size_t most_looked_at = 32;  ///< samples whose rotations say so
  double least_noise = 1e-10;       ///< [rad]; residuals below it are rounding
};

/// Answers that fit the rotations of the chosen samples about as well as `fit`: first guesses, their noise
/// and statistics are those of `fit`. Mostly none.
std::vector<SampleFit> half_turned(const SampleSet& set, std::span<const std::size_t> chosen,
                                   const SampleFit& fit, const HalfTurnOptions& options = {});

/// The fit of all samples, which are few: of all choices of signs that half turns leave open the one that
/// fits best.
SampleFit fit_of_few(const SampleSet& set, const FitSettings& settings, const HalfTurnOptions& options = {});

}  // namespace egocal::detail
