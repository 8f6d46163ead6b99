// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Parts of a stream that were filled in where it had no poses, or no positions: by straight lines, by the
// last velocity, or by what was there last.
#pragma once

#include <optional>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

struct FilledGapsOptions {
  std::size_t most = 20000;  ///< poses that are looked at, from the middle: bounds the cost of a long drive
  std::size_t least = 10;    ///< poses on one line
  std::size_t most_lines = 100;  ///< the longest ones, which are looked at: bounds the cost of smooth streams
  /// The motions of either half of a line leave this many times what is usual, in rotation or translation:
  /// a sensor that really moves evenly agrees with the other one.
  double times = 10;
  double least_left = 2e-3;    ///< and this much [rad, and of the way]: less is noise of good sensors
  double usual = 0.25;         ///< the quantile that is: filled gaps may be in half of the motions
  double as_far = 0.3;         ///< motions that are compared, as a part of the way and turn of a half line
  std::size_t compared = 100;  ///< motions, evenly spread
  std::size_t fewest = 10;     ///< of them
};

/// Finding filled_a or filled_b, certain, with the first such part. A line must span three instants: one
/// instant between its ends is a wrong pose of the other stream as well.
std::optional<Finding> filled_gaps(const Evidence& evidence, const DualQuaternion& T_a_b,
                                   const FilledGapsOptions& options = {});

}  // namespace egocal::detail
