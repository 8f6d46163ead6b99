// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/reading/either_way_summary.hpp"

namespace egocal::tools {

void EitherWaySummariser::add(const StampedPose& pose) {
  forward_.add(pose);
  StampedPose mirrored = pose;
  mirrored.time_us = -pose.time_us;
  backward_.add(mirrored);
}

StreamSummary EitherWaySummariser::summary() const {
  const StreamSummary forward = forward_.summary();
  StreamSummary backward = backward_.summary();
  if (backward.out_of_order >= forward.out_of_order) return forward;
  backward.first_us = forward.first_us;
  backward.last_us = forward.last_us;
  backward.out_of_order = forward.out_of_order;
  return backward;
}

}  // namespace egocal::tools
