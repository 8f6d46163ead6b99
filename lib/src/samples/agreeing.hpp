// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which samples agree on one hand-eye pose.
#pragma once

#include <cstddef>
#include <vector>

#include "egocal/samples/calibrate_samples.hpp"
#include "samples/sample_fit.hpp"

namespace egocal::detail {

/// Samples that agree, ascending, and their fit.
struct AgreeingSamples {
  std::vector<std::size_t> chosen;
  SampleFit fit;
};

/// Steps of the search for samples that agree. Study: tests/bench/sample_study.cpp.
struct AgreeingOptions {
  /// Steps of each start, of the start from all samples, and of the best ones, which are followed until they
  /// settle.
  int first_steps = 2, steps_from_all = 3, last_steps = 10;
  std::size_t most_followed = 6;  ///< of the starts, the best trimmed fits
  /// The same minimum again has the same logarithm of squares to less than this.
  double least_gain = 0.2;
  /// Rounds of a fit on the way: only the last fit has to be exact.
  int rounds_on_the_way = 3;
  /// A sample that noise explains this often is accepted without a second test.
  double unremarkable = 0.01;
  /// Up to this many samples the nearest one is found by fits with each, and taken in alone. Beyond, where a
  /// sample has about a hundredth of the fit, its residual decides, and this part of those that agree is
  /// taken in at once: the time grows with the samples, not with their cube.
  std::size_t most_one_by_one = 300;
  double at_once = 0.02;
  /// From this many samples on the noise of the rotations is known without an answer, to a third.
  std::size_t least_for_congruence = 12;
  /// Samples that agree need no search from triples where they are at least most_samples of all, their
  /// rotations are as good as the angles of the motions allow (up to this factor), and the positions of the
  /// best 60 % are no better than a normal distribution has it (0.63 of the variance).
  double most_samples = 0.8, as_good = 1.5, least_trimmed = 0.35;
  /// The noise of exact samples is that of rounding: their variance is not taken to be smaller than this part
  /// of it.
  double least_variance = 1e-3;
  /// A noise of the rotations below this is rounding [rad].
  double least_noise = 1e-10;
  /// Added to sums of squares in parts of the length before their logarithm: (1e-12)^2, rounding.
  double nothing = 1e-24;
};

/// The fit of all samples, whether they agree or not.
SampleFit fit_of_all(const SampleSet& set, const SampleOptions& options);

/// Least trimmed squares over triples of samples, then samples are added again, best first, as long as
/// noise explains them (F test of what one more adds to the cost). All samples where their units
/// (shared_poses.hpp) are too few to judge.
AgreeingSamples find_agreeing(const SampleSet& set, const SampleOptions& options,
                              const AgreeingOptions& tuning = {});

}  // namespace egocal::detail
