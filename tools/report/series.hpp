// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "egocal/calibrate.hpp"
#include "report/drawn_time.hpp"

namespace egocal::tools {

/// Residual of each motion pair at an extrinsic, over the time of its end.
struct Residuals {
  std::vector<double> time;         ///< drawn time [s]
  std::vector<double> rotation;     ///< [deg]
  std::vector<double> translation;  ///< [m]
};
/// The motion of a, predicted from b through T_a_b, against the motion of a: A^-1 (T B T^-1).
Residuals residuals_of(const std::vector<MotionPair>& pairs, const Pose& T_a_b, const DrawnTime& time);

/// Both paths in one picture plane: the two directions in which sensor a travelled most. A break interrupts a
/// path by a point that is not a number: each part may have a frame of its own.
struct Map {
  std::vector<double> a_x, a_y;  ///< path of sensor a [m]
  std::vector<double> b_x, b_y;  ///< path of sensor a as sensor b saw it, through T_a_b [m]
};
Map map_of(const Trajectory& a, const Trajectory& b, const Pose& T_a_b, const DrawnTime& time);

/// Standard deviations while the drive grew.
struct Progress {
  std::vector<double> time;       ///< drawn time [s]
  std::vector<double> stddev[6];  ///< x y z [m], roll pitch yaw [rad]; infinite where not observable
};
/// points: how often the answer is asked for.
Progress progress_of(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options, int points,
                     const DrawnTime& time);

/// How fast sensor a turned about its own axes, and how fast it moved: what makes directions observable.
struct Excitation {
  std::vector<double> time;                ///< drawn time [s]; not a number at a break
  std::vector<double> turning[3];          ///< about x, y, z of sensor a [deg/s]
  double root_mean_square[3] = {0, 0, 0};  ///< of the same [deg/s]
  double path = 0;                         ///< length of the path [m]
};
/// Rates over at least a tenth of a second, none over a break.
Excitation excitation_of(const Trajectory& a, const DrawnTime& time);

}  // namespace egocal::tools
