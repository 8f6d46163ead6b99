// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Mistakes that both lists share, which leave the samples in agreement.
#pragma once

#include <optional>
#include <span>

#include "egocal/samples/calibrate_samples.hpp"
#include "samples/agreeing.hpp"

namespace egocal::detail {

/// Tuning of the findings about both lists. Study: tests/lib/test_samples_mistakes.cpp and docs/samples.md,
/// "Measured".
struct BothListsOptions {
  /// How much likelier the residuals must be under one reading before noise decides (logarithm): 150 to 1.
  double least_likelier = 5;
  /// The camera sits on the hand, which is far from the base: the one pose is this many times as long as the
  /// other.
  double clearly_longer = 2;
  /// Typical distances between positions that no arm has, and hardly any [m]. The longest arms reach 5 m; in
  /// millimetres a desk has 500, in centimetres 50.
  double impossible = 100, unlikely = 10;
};

/// Finding inverted_both, never certain. With both lists inverted X and Y change places, and the motions
/// agree as well. For a camera on the hand the lengths tell: an X much shorter than Y is as it should be, one
/// much longer is named. Otherwise noise may tell, unless most of it is of the arm: a camera errs in its own
/// frame, so the errors of position are larger by what the rotations err at that distance under the wrong
/// reading. Named, too, where it says nothing.
std::optional<Finding> both_inverted(std::span<const PoseSample> samples, const SampleSet& set,
                                     const AgreeingSamples& given, const SampleOptions& options,
                                     const BothListsOptions& both = {});

/// Finding units: lengths of both lists that are not metres. Certain from `impossible` on.
std::optional<Finding> not_in_metres(const SampleSet& set, const SampleFit& fit, const SampleOptions& options,
                                     const BothListsOptions& both = {});

}  // namespace egocal::detail
