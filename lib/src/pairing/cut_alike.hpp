// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Interpolation cuts the corners of the path of one stream. The path of the other stream is cut alike, so
// that both lose the same.
#pragma once

#include <cstdint>
#include <deque>

#include "egocal/pairing/options.hpp"
#include "egocal/pairing/synchroniser.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct Neighbours {
  const StampedPose& before;
  const StampedPose& pose;
  const StampedPose& after;
};

/// The place between two poses at which the other stream is interpolated; its clock may differ from that of
/// the stamps.
struct InterpolatedPart {
  double part = 0;              ///< of the way to the second one
  double gap_us = 0;            ///< time between the two
  std::int64_t max_gap_us = 0;  ///< longest time to a neighbour
};

KeyStep step_of(const DualQuaternion& motion);
/// Medians of the steps; zero where there are none.
KeyStep typical(const std::deque<KeyStep>& steps);

/// The middle pose, which is paired with an interpolated one. With h the time between the two poses that are
/// interpolated, x the time since the first, and p'' how the path bends, the interpolated pose is x (h - x) /
/// 2 p'' off its path. The middle pose is h_before h_after / 2 p'' off the path between its neighbours: it
/// moves towards that path by the quotient of the two. Both sensors are on one body, so their paths bend
/// alike. Returns the pose as it is where a neighbour is too far away or the options do not allow it.
/// typical: of the steps of its stream.
DualQuaternion cut_alike(const Neighbours& neighbours, const InterpolatedPart& interpolated,
                         const KeyStep& typical, const SynchroniserOptions& options);

/// The same for any pose of a recorded stream. The typical step is the shorter one of the steps to and from
/// it.
DualQuaternion cut_alike(const Neighbours& neighbours, const InterpolatedPart& interpolated,
                         const SynchroniserOptions& options);

}  // namespace egocal::detail
