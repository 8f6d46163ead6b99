// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "egocal/estimation/stride_sums.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal {

/// A problem made of the motions of many strides.
struct StrideProblem {
  Problem problem;
  /// Its single stride and balance are those that come closest.
  Choice choice;
  std::uint64_t matched = 0;   ///< steps between neighbouring instants in the statistics
  std::uint64_t outliers = 0;  ///< steps that are not: jumps, and blocks that contradict the others
};

/// The whole of two streams, as MotionPairing synchronises and screens them, by StrideSums. options: neither
/// stride nor balance may be given, and robust must be set; time_offset counts, track_time_offset does not.
/// Empty otherwise, and where the streams are too short for a choice (options.accumulator.first_choice) or
/// show nothing: then MotionPairing::problem() is all there is.
std::optional<StrideProblem> sum_over_strides(const PairingOptions& options, const Trajectory& a,
                                              const Trajectory& b, const StrideSumsOptions& tuning = {});

}  // namespace egocal
