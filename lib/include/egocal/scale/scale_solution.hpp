// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/problem/cost.hpp"

namespace egocal {

/// The scale and the extrinsic that minimise the cost together.
struct ScaleSolution {
  double scale = 1;  ///< what the translations of `side` are multiplied by
  DualQuaternion q;  ///< the minimiser of (18) at that scale: T_a_b (planar mode: T_p)
  double cost = 0;   ///< J
  Balance balance;   ///< in force at that scale: the q above minimises cost_matrix(at_scale(...), balance)
  double lower_bound = 0;  ///< no scale in the range and no extrinsic has a cost below it, up to rounding
  double gap = 0;          ///< cost - lower_bound, >= 0
  double rounding = 0;     ///< costs that differ by less than this are equal
  /// No scale outside of these two has as low a cost.
  double least_scale = 0, most_scale = 0;
  bool certified = false;  ///< the gap is within the tolerance, and q is certified at the scale
  bool at_limit = false;   ///< the best scale is the end of the range
  double stddev = 0;       ///< by the jack-knife over blocks, with `attenuation`; infinite where unknown
  /// Change of the best extrinsic per relative change of the scale, x y z roll pitch yaw in the frame of q
  /// [m, rad]. What an extrinsic at this scale does not know of it: with_spread_of_scale().
  std::array<double, 6> sensitivity{};
  /// Errors in variables: the true scale lies within this part of the scale of it, if all translation noise
  /// is in one sensor or the other; with noise as ScaleOptions::noise assumes nothing of it is left.
  double attenuation = 0;
  /// Curvature of the cost over the scale against that at a fixed extrinsic, in [0, 1]: 0 shows no scale
  /// (pure rotation, or one circle at constant speed, where another lever arm explains another scale).
  double observability = 0;
  bool observable = false;
  int solves = 0;  ///< certified solves of the branch and bound
};

}  // namespace egocal
