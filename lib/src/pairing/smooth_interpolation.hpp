// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Interpolates a pose of a stream from several poses on both sides.
#pragma once

#include <optional>
#include <span>

#include "egocal/pairing/options.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// The pose at `part` of the way (in time) between the two middle ones of an even number of poses, in order.
/// The six coordinates of the path, as seen from the earlier one of the two, are predicted without bias for
/// cubic polynomials and with the least mean square for a Gaussian correlation (universal kriging), so motion
/// up to 0.4 times the rate of the stream keeps its amplitude, whether or not the periods are even. A screw
/// between two poses loses a third at 0.3 times the rate. Empty where the path is not smooth at this rate: a
/// pose off the path between its neighbours (outlier, jump), repeated poses, a pause, more than half a turn.
/// poses: at least 4, at most SynchroniserOptions::most_smooth_poses.
std::optional<DualQuaternion> interpolate_smoothly(std::span<const StampedPose> poses, double part,
                                                   const SynchroniserOptions& options);

}  // namespace egocal::detail
