// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/options.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::detail {

/// When a ground plane is wrong. Study: the authors' planes of KITTI on five pairs of streams (05 and 07 with
/// two lidar odometries, raw 0930_27), and simulated cars on flat, rolling and hilly ground, ramps and
/// circles with sensors mounted rolled and pitched.
struct PlaneTiltOptions {
  /// Number of parts of the drive. The jack-knife omits one at a time, for the spread of what the turns say,
  /// which is then known to a fifth. Between 8 and 32 it changes little.
  std::size_t blocks = 16;
  double sigmas = 3;  ///< of that spread, beyond the limits below
  /// How far the normals may be apart by the turns of both sensors [rad]: 0.32 to 0.48 degrees for the planes
  /// of KITTI, below 0.1 in the simulation. Within it the answer keeps to a degree
  /// (DiagnosisOptions::tolerance_rotation).
  double apart = 0.75 * radians_per_degree;
  /// Correlation of the turns of both sensors from which they say how far the normals are apart: two thirds
  /// of their squares are no noise. Straight drives have 0.0 to 0.3, and called honest planes 112 degrees
  /// apart.
  double least_alike = 0.7;
  /// How far a normal may be from the axis that its sensor turns about [rad]. A body leans out of curves, by
  /// up to 3 degrees where it is driven hard and one way round; both sensors see that alike. KITTI: 0.2 to
  /// 0.6 degrees, hills 0.9.
  double alone = 4 * radians_per_degree;
  /// Which of two normals that are apart is wrong: the one that is this part of it off its own axis, where
  /// the other one is not even the smaller part off. Mathematics: 1 and 0 but for what both sensors see.
  double blamed = 0.7, cleared = 0.35;
  /// No vehicle on the ground carries a sensor higher [m]: straddle carriers of ports are 15 m high. A
  /// height in millimetres is beyond it from 3 cm on.
  double most_height = 30;
};

/// Whether the ground planes suit the motions: the ground is below the sensors by what vehicles are high, and
/// the normals are those that the turns of both sensors say, in the same sense. The distances leave no trace
/// in the motions. given: the motions with the extrinsic that suits them best, in all six directions. metres:
/// whether lengths are.
std::vector<Finding> check_planes(const Explained& given, const GroundPlane& a, const GroundPlane& b,
                                  bool metres, const PlaneCheckOptions& options,
                                  const PlaneTiltOptions& tilt = {});

}  // namespace egocal::detail
