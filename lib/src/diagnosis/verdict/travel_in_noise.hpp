// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A sensor that turns about itself, as on a pan-tilt head: its positions change by their noise alone, and no
// extrinsic explains these.
#pragma once

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/options.hpp"

namespace egocal::detail {

struct TravelInNoiseOptions {
  /// Steps from one instant to the next are compared with motions over as many of them, at least: of a body
  /// that goes on the steps travel a quarter as far.
  int least_stride = 4;
  /// Steps travel at least this part of the way of motions, where a stream goes nowhere. White noise: 1; a
  /// sensor that also travels as far as its noise: 0.7.
  double as_far = 0.7;
  /// And the answer leaves at most this many times what such a stream travels: what the other one travels is
  /// explained.
  double most_left = 1.3;
  /// The residual rotation is at most this part of the typical rotation, in the median.
  double most_of_rotation = 0.2;
};

/// Whether the positions of one stream, or both, change by noise alone, the answer leaves no more than that,
/// and the rotations agree: the translations then neither support nor contradict the answer. motions: of the
/// instants, sampled so.
bool travel_in_noise(const Instants& instants, const Motions& motions, const Pose& T_a_b,
                     const MotionSampleOptions& sample, const TravelInNoiseOptions& options = {});

}  // namespace egocal::detail
