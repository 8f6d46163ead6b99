// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is left of a drive where a stream freezes at times: the rest may have another mistake.
#pragma once

#include <cstddef>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// Study: 24 drives with a frozen quarter and another mistake (docs/trust_rules.md, "Streams that freeze").
struct AwakeStreamsOptions {
  double rounding = 1e-13;  ///< as StreamCheckOptions::rounding
  /// Poses that are repeated one after the other; fewer leave no gap that matters.
  std::size_t least = 4;
  /// The other stream moves meanwhile if it ends further away than this many of its usual steps: noise at
  /// rest goes back and forth. Pauses of an arm are no freezes.
  double least_steps = 2;
};

struct AwakeStreams {
  Trajectory a, b;
};

/// The streams without the poses that one of them repeats while the other one moves; the first of the
/// repeated poses stays. time_offset: added to the stamps of b [s].
AwakeStreams without_frozen_poses(const Trajectory& a, const Trajectory& b, double time_offset,
                                  const AwakeStreamsOptions& options = {});

}  // namespace egocal::detail
