// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/evaluation/errors.hpp"
#include "egocal/problem/problem.hpp"
#include "experiments/data_set.hpp"

namespace egocal::tools {

/// One method on one data set: a line of Table I or II.
struct ComparisonRow {
  std::string method;  ///< as in the tables: "analytic [19]", "global (dual)", ...
  Mode mode = Mode::spatial;
  DualQuaternion T_a_b;
  std::optional<ExtrinsicError> error;  ///< (32), where the truth is known
  double milliseconds = 0;              ///< from motion pairs to the answer, median of the repeats
  std::string verdict;                  ///< "certified", "valid", or why it is neither
};

/// Every method on the same pairs; the planar ones where both ground planes are known. repeats: of each, for
/// the time.
std::vector<ComparisonRow> compare(const DataSet& data, int repeats);

/// The rows as text for people, centimetres and degrees.
std::string table(const std::vector<ComparisonRow>& rows);

}  // namespace egocal::tools
