// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A mounting that slips while the samples are taken.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "egocal/diagnosis/verdict.hpp"
#include "egocal/samples/named_samples.hpp"
#include "samples/agreeing.hpp"

namespace egocal::detail {

/// Tuning of find_slip(). Study: tests/lib/test_samples_mistakes.cpp and docs/samples.md, "Measured".
struct SlipOptions {
  std::size_t least_part = 4;    ///< units before the slip, and after it
  std::size_t most_places = 64;  ///< that are tried
  /// Probability that noise alone makes the two parts of any place as unlike: as for a wrong sample.
  double by_chance = 1e-6;
  /// Errors that depend on the pose (a lens, the lengths of the arm) also divide the samples, but best by
  /// where they are. The order in time must explain this many times as much as the best of orders by position
  /// and rotation, and leave the variance smaller by this factor.
  double than_other_orders = 1.5, least_gain = 1.15;
  /// Certain where the variance is that many times smaller with a slip.
  double certain_gain = 2;
  /// Samples that were rejected count again where a slip explains them as well as the others: to this many
  /// times the variance.
  double as_good = 2;
};

/// What a finding says of a slip.
struct FoundSlip {
  std::size_t sample = 0;  ///< the first one after it, as given
  bool of_target = false;
  double shift = 0, turn = 0;  ///< [m, rad]
  double gain = 1;             ///< of the squared residuals
  Pose after;                  ///< the answer after it
};

/// The finding mount_moved of a slip. metres: what lengths are in, or units of their own.
Finding worded_slip(const FoundSlip& slip, const SampleNames& names, bool metres, bool certain);

/// Finding mount_moved where the camera (another X) or the target (another Y) is elsewhere from some sample
/// on. An F test at each place, linear around the fit, with Bonferroni's factor. order: samples in the order
/// in which they were taken, of which `given` says the place of each among those given, which have these
/// names. Only this finding depends on the order. metres: what lengths are in, or units of their own. T_a_b:
/// the answer after the slip.
std::optional<Finding> find_slip(const SampleSet& set, const AgreeingSamples& agreeing,
                                 const std::vector<std::size_t>& order, const std::vector<std::size_t>& given,
                                 const SampleNames& names, bool metres, const SlipOptions& options = {});

}  // namespace egocal::detail
