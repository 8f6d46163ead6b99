// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "egocal/calibrate.hpp"

namespace egocal::tools {

/// Residual of each motion pair at an extrinsic, over the time of its end since the first one.
struct Residuals {
  std::vector<double> time;         ///< [s]
  std::vector<double> rotation;     ///< [deg]
  std::vector<double> translation;  ///< [m]
};
/// The motion of a, predicted from b through T_a_b, against the motion of a: A^-1 (T B T^-1).
Residuals residuals_of(const std::vector<MotionPair>& pairs, const Pose& T_a_b);

/// Both paths in one picture plane: the two directions in which sensor a travelled most.
struct Map {
  std::vector<double> a_x, a_y;  ///< path of sensor a [m]
  std::vector<double> b_x, b_y;  ///< path of sensor a as sensor b saw it, through T_a_b [m]
};
Map map_of(const Trajectory& a, const Trajectory& b, const Pose& T_a_b);

/// Standard deviations while the drive grew.
struct Progress {
  std::vector<double> time;       ///< since the first pose [s]
  std::vector<double> stddev[6];  ///< x y z [m], roll pitch yaw [rad]; infinite where not observable
};
/// points: how often the answer is asked for.
Progress progress_of(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options, int points);

/// How fast sensor a turned about its own axes, and how fast it moved: what makes directions observable.
struct Excitation {
  std::vector<double> time;                ///< since the first pose [s]
  std::vector<double> turning[3];          ///< about x, y, z of sensor a [deg/s]
  double root_mean_square[3] = {0, 0, 0};  ///< of the same [deg/s]
  double path = 0;                         ///< length of the path [m]
};
/// Rates over at least a tenth of a second.
Excitation excitation_of(const Trajectory& a);

}  // namespace egocal::tools
