// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// One coordinate of the positions of one stream, in its own world, that is late beside the others: a height
// from a barometer, or a filter with a time constant of its own.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Study: docs/trust_rules.md, "One coordinate that is late".
struct LateColumnOptions {
  double least_span = 0.2;          ///< a speed is measured over at least this time [s]
  std::size_t most_instants = 200;  ///< and over at most this many instants on each side
  double least = 0.05;              ///< delays below this are not named [s]
  double most = 10;                 ///< nor above: what is not measured at all [s]
  /// A coordinate is looked at closer where its delay explains this part of the residual translations, as
  /// root mean squares.
  double first_look = 0.15;
  /// The blocks of the drive may not show the delay. Then it must be larger than this many of its standard
  /// deviations.
  double sigmas = 5;
  std::size_t parts = 24;    ///< of the drive; each is omitted in turn for that standard deviation
  double least_gain = 0.05;  ///< mean logarithm of the squared residuals then, at least
  /// A coordinate of the other stream is named too where it gains at least this part: less is what the noise
  /// of one is in the other.
  double as_likely = 0.5;
};

/// The coordinate that is late, and the extrinsic without that, where the motions then fit clearly better:
/// late_positions_a or late_positions_b, uncertain. Both, the better one first, where either may be the one:
/// where vertical axes are parallel, a height that is late looks like another one that is early. instants,
/// given: the drive, and its motions with the extrinsic that suits them as they are.
std::vector<Finding> late_column(const Instants& instants, const Explained& given,
                                 const DiagnosisOptions& options, const LateColumnOptions& late = {});

/// Adds by how much the answer without the delay differs from the answer to answered.timing_stddev and
/// result.timing_stddev, where result has that finding. late: of late_column().
void widen_by_late_column(const std::vector<Finding>& late, Answered& answered, Diagnosis& result);

}  // namespace egocal::detail
