// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A wrong scale is the same all through the drive. Noise that is remembered for as long as the drive lasts
// also makes the lengths of one stream seem too long, in one part more than in another.
#pragma once

#include <cstddef>

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/options.hpp"

namespace egocal::detail {

struct ScaleInPartsOptions {
  std::size_t parts = 4;  ///< of the drive: fewer say nothing of their scatter, more are not independent
  /// A scale is certain where its logarithm is at least this many times its scatter between the parts. Of ten
  /// drives with a scale of 1.05 and 0.5 to 5 % noise the least has 12; of ten with the right one and noise
  /// that is remembered for as long as the drive (seeds 1000 to 1201 of docs/trust_rules.md, "Noise that is
  /// remembered") seven have 1.2 to 5.2, three more than 11.
  double times = 8;
  /// Beyond this logarithm no noise makes a scale: that of 10 % that wanders reaches 0.11.
  double beyond = 0.2;
};

/// Standard deviation of the logarithm of the scale of b between parts of the drive, at the extrinsic and
/// with the weights of a fit with one scale; infinite where a part shows none.
double scatter_of_log_scale(const Motions& motions, const Explained& fitted, std::size_t parts);

/// Whether the scale of b is as large in all parts of the drive, to a part of what it differs from one by.
bool same_scale_in_parts(const Evidence& evidence, const Explanation& scaled,
                         const ScaleInPartsOptions& options = {});

}  // namespace egocal::detail
