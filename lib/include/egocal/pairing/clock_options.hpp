// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace egocal {

/// Tuning of the ClockFollower. Study: tests/lib/test_time_offset.cpp, over noise, glitches, drift and
/// interleaving.
struct ClockOptions {
  double first = 10;     ///< length of the first estimate's streams, and of what each next one adds [s]
  double every = 30;     ///< between estimates once one is in force [s]: quartz changes over minutes
  double delay = 2;      ///< from the end of an estimate's streams until it comes into force [s]
  double window = 60;    ///< newest part of the streams that an estimate looks at once one is in force [s]
  double longest = 180;  ///< poses are held for at most this long, and until the first estimate looked at [s]
  std::size_t most_held = 200'000;  ///< poses of one stream: 180 s at 1 kHz
  /// Below these an estimate is not trusted: unrelated streams reach a correlation of 0.5 by chance.
  double least_correlation = 0.7, least_inliers = 0.5;
  double largest_stddev = 0.005;  ///< [s]: at 1 rad/s an error of 0.3 deg
  /// Another offset comes into force where it differs by both [s, standard deviations].
  double least_change = 0.005, change_sigmas = 4;
  /// Share of the estimate that is worked out at each pose, in poses looked at: about 0.2 ms.
  std::size_t work_per_pose = 512;
  double phase = 0;  ///< in [0, 1): several pairs of one rig estimate at different times
};

}  // namespace egocal
