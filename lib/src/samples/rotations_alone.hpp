// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "egocal/samples/calibrate_samples.hpp"

namespace egocal::detail {

/// The rotations of X and Y that suit those of the samples best, whatever the positions.
struct RotationsAlone {
  QuaternionVector X = QuaternionVector::Unit(0), Y = QuaternionVector::Unit(0);
  double variance = 0;  ///< of one sample, each axis [rad^2]
};

/// rounds_of_signs: of the quaternions and the sum alternately. At least two samples.
RotationsAlone rotations_alone(std::span<const PoseSample> samples, int rounds_of_signs);

}  // namespace egocal::detail
