// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace egocal {

enum class OutlierChoice {
  proven,      ///< no other choice of outliers has an extrinsic with a lower truncated cost
  not_proven,  ///< nothing is known of other choices
  not_best,    ///< another choice with a lower truncated cost is known
};
std::string_view to_string(OutlierChoice choice);

/// What is known of a choice of outliers.
struct OutlierProof {
  OutlierChoice choice = OutlierChoice::not_proven;
  /// Truncated cost of the answer: the weighted squares of each part, at most its limit, summed over the
  /// parts and not divided by the sum of eta. It has no unit, as (16) has none.
  double cost = 0;
  std::size_t undecided = 0;  ///< parts that the leverages do not decide
  std::size_t solves = 0;     ///< of the search through them
  /// not_best: which parts are the outliers of the better choice. Parts are consecutive blocks of the drive
  /// in the order of time, then the single motions that were judged by themselves. Otherwise empty.
  std::vector<bool> better;
};

}  // namespace egocal
