// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A mounting that slips by so much that no answer of all samples is near that of either part.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "egocal/diagnosis/verdict.hpp"
#include "egocal/samples/named_samples.hpp"
#include "samples/agreeing.hpp"

namespace egocal::detail {

/// Tuning of find_large_slip(). Study: targets that were moved by 2 to 40 cm and 2.5 to 50 deg
/// (docs/samples.md, "Measured").
struct LargeSlipOptions {
  /// Least number of units before the slip, and after it. Each part has twelve numbers of its own, so that
  /// few poses agree by chance.
  std::size_t least_part = 6;
  std::size_t most_places = 24;  ///< that are tried first: two fits each
  /// A large slip is looked for where one sample has more noise than this, in parts of the length or in
  /// radians: below it the test that is linear around the answer of all finds more.
  double least_noise = 0.03;
  /// Two parts leave the variance smaller by this factor, so that errors of a lens or of the lengths of an
  /// arm, which also differ from part to part, are no slip. From the second one on it is certain.
  double least_gain = 16, certain_gain = 100;
  /// Samples that do not count, exactly those before or after some row, are a slip on their own: of thirty
  /// samples a tenth would be the last ones by chance once in 4,000 sets. Both parts are then better by this
  /// factor.
  double least_gain_of_rejected = 2;
};

/// Finding mount_moved: the samples before some row and from it on agree among themselves, with two places of
/// the camera or of the target. order, given, names: as of find_slip(). T_a_b: the answer after the slip.
std::optional<Finding> find_large_slip(const SampleSet& set, const AgreeingSamples& agreeing,
                                       const std::vector<std::size_t>& order,
                                       const std::vector<std::size_t>& given, const SampleNames& names,
                                       const SampleOptions& options, const LargeSlipOptions& tuning = {});

}  // namespace egocal::detail
