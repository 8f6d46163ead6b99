// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/problem/cost.hpp"

namespace egocal {

/// The scale and the extrinsic that minimise the cost together.
struct ScaleSolution {
  double scale = 1;  ///< what the translations of the sensor without a known unit are multiplied by
  DualQuaternion q;  ///< the minimiser of (18) at that scale: T_a_b (planar mode: T_p)
  double cost = 0;   ///< J
  Balance balance;   ///< in force at that scale: q minimises (18) of the scaled motions with these weights
  double lower_bound = 0;  ///< no scale in the range and no extrinsic has a cost below it, up to rounding
  double gap = 0;          ///< cost - lower_bound, >= 0
  double rounding = 0;     ///< costs that differ by less than this are equal
  /// No scale outside of these two has as low a cost. They are scales as `scale` is one, not parts of it.
  double least_scale = 0, most_scale = 0;
  bool certified = false;  ///< the gap is within the tolerance, and q is certified at the scale
  bool at_limit = false;   ///< the best scale is the end of the range
  /// Absolute standard deviation of `scale`; stddev / scale is the relative one. It is from the jack-knife
  /// over blocks, with `attenuation`; infinite where unknown.
  double stddev = 0;
  /// Change of the best extrinsic per relative change of the scale, x y z roll pitch yaw in the frame of q
  /// [m, rad]. What an unknown scale adds to the variance of a direction is the square of
  /// sensitivity * stddev / scale; calibrate() has added it.
  std::array<double, 6> sensitivity{};
  /// Errors in variables: where all translation noise is in one of the two sensors, `scale` is off by at most
  /// this part of it. Where both have as much, as is assumed, nothing of it is left.
  double attenuation = 0;
  /// Curvature of the cost over the scale against that at a fixed extrinsic, in [0, 1]: 0 shows no scale
  /// (pure rotation, or one circle at constant speed, where another lever arm explains another scale).
  double observability = 0;
  bool observable = false;
  int solves = 0;  ///< certified solves of the branch and bound
};

}  // namespace egocal
