// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whether both streams disagree by more than the noise of their steps.
#pragma once

#include "diagnosis/motions/motions.hpp"

namespace egocal::detail {

struct TurningNoiseOptions {
  /// Least part of the squared residual that the noise explains. Honest odometries on slow cars, 0.05 to 0.5
  /// degrees a step, have 0.7 to 1.5; two drives that are not one have at most 0.3, unless more than half of
  /// what they turn by is noise.
  double least = 0.5;
  /// Translations that leave a larger part of the way agree by chance only: on level roads without much
  /// turning two drives leave 0.2 to 0.35 (at one constant speed less, which no stream shows).
  double most_of_way = 0.2;
};

/// Noise of an odometry turns to and fro, a body turns on: what the halves of each motion turn unlike is
/// noise, and explains what the rotations of both streams leave at T; and the same of the lengths. Medians,
/// which wrong poses do not change.
bool steps_leave_noise(const Instants& instants, const Motions& motions, const Pose& T,
                       const TurningNoiseOptions& options = {});

}  // namespace egocal::detail
