// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "egocal/diagnosis/verdict.hpp"

namespace egocal::services {

struct UnseenOptions {
  /// A verdict may be `good` while at most this part of the motions was not judged. That many wrong motions
  /// are found as outliers (docs/accuracy.md, "Gross outliers").
  double largest_share = 0.2;
  /// Fewer poses of a stream say nothing about a drive: it is judged by the statistics alone, which do not
  /// say whether the motions agree.
  std::size_t least_poses = 30;
};

/// What a process that was started within a session has not seen of it, or had to forget: poses of before the
/// clock of a sensor was set back belong to another timeline.
struct Unseen {
  double share = 0;       ///< of the motions behind the answer
  double seconds = 0;     ///< from the session's start
  std::size_t poses = 0;  ///< that it knows of each stream, at common times
  bool within = false;    ///< some of it is not at the start: the process was killed and started again
};

/// Motions that were not judged may contradict the later ones, for instance where a mount moved before. The
/// answer is not called good until the part that was not judged is small.
void limit_to_what_was_seen(const Unseen& unseen, Diagnosis& diagnosis, const UnseenOptions& options = {});

}  // namespace egocal::services
