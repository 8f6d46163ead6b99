// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A stream that was computed from the other one and written with few digits: its motions agree with those of
// the other one to what the digits leave, as those of two sensors hardly do.
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "diagnosis/streams/written_digits.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct RoundedCopyOptions {
  WrittenDigitsOptions digits;
  std::size_t fewest = 20;  ///< instants, and motions
  /// The median of the residuals over what rounding leaves, at most: 0.60 to 1.12 in copies of 11 simulated
  /// machines with 3 to 5 decimals and with 6 digits. Noise of the sensors that is as large as two thirds of
  /// the rounding makes 1.2 of 1.
  double most = 1.2;
  /// Where the typical residual is this part of the typical motion or more it is noise: a look that costs
  /// less than counting digits does.
  double certainly_noise = 0.01;
  /// Rounding of more than this part of the usual motion says nothing: sensors may be as good.
  double most_of_motion = 3e-3;
  /// Less than this [rad, and of the way] counts as rounding, too; if no more was rounded it is for
  /// made_from_each_other().
  double least = 1e-5;
  std::size_t motions = 300;  ///< that are compared, of either length
  std::size_t parts = 32;     ///< of the drive that the longer motions span; the shorter ones an eighth
};

/// same_stream, uncertain. metres: what the lengths are in, or units of their own. What rounding leaves does
/// not grow with the length of the motions, other noise does: both short and long ones must agree to it.
std::optional<Finding> rounded_copy(const Trajectory& a, const Trajectory& b, const Instants& instants,
                                    bool metres, const RoundedCopyOptions& options = {});

}  // namespace egocal::detail
