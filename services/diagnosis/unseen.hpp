// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "egocal/diagnosis/verdict.hpp"

namespace egocal::services {

struct UnseenOptions {
  /// A verdict may be `good` while at most this part of the motions was not judged: up to that part, wrong
  /// motions are found as outliers (docs/accuracy.md, "Gross outliers").
  double largest_share = 0.2;
  /// With fewer poses of a stream the motions cannot be judged. The verdict is then based on the statistics
  /// alone, which do not show whether the motions agree.
  std::size_t least_poses = 30;
};

/// The part of a session that a diagnosis process cannot judge: motions before its start, and poses from
/// before a clock was set back, which belong to another timeline.
struct Unseen {
  double share = 0;       ///< of the motions behind the answer
  double seconds = 0;     ///< from the session's start
  std::size_t poses = 0;  ///< poses at common times that the process has of each stream
  bool within = false;    ///< a part in the middle is missing: the process was killed and restarted
};

/// Motions that were not judged may contradict the judged ones, for instance if a mount moved before. So the
/// verdict is not `good` until the part that was not judged is small.
void limit_to_what_was_seen(const Unseen& unseen, Diagnosis& diagnosis, const UnseenOptions& options = {});

}  // namespace egocal::services
