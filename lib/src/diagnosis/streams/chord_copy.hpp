// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A stream that was looked up in a tree of frames: the other one, interpolated linearly at stamps of its own
// and moved by one transform.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/explanations/times/clock.hpp"
#include "egocal/diagnosis/verdict.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct ChordCopyOptions {
  std::size_t looked_at = 400;  ///< rows of a stream, evenly spread, at most
  std::size_t fewest = 20;      ///< motions between them
  /// A row must be this part of the way away from both poses beside it: there a stream without noise differs
  /// from the line between them.
  double from_ends = 0.15;
  /// What is left on the lines between neighbours, over what is left on lines from one pose earlier to one
  /// later. Of two sensors the noise is left on both (0.6 and more of simulated ones). Of streams without
  /// noise, in curves, a thirteenth is in the mean, and 0.06 at from_ends. Copies leave their digits.
  double most = 0.02;
  /// What is left on the longer lines, at least [rad, and of the typical motion]: digits of doubles.
  double least = 1e-6;
  /// What is left on the lines between neighbours, at most: six digits of a file. Sensors with a noise of 0.1
  /// % leave 1e-3, and with wrong poses among theirs the longer lines, which have more of them, leave any
  /// number.
  double digits = 2e-5;
};

/// same_stream, certain: rotations and positions of one stream lie on the lines between the poses of the
/// other one. clock: of b. max_gap: [s].
std::optional<Finding> chord_copy(const Trajectory& a, const Trajectory& b, const ClockModel& clock,
                                  double max_gap, const ChordCopyOptions& options = {});

}  // namespace egocal::detail
