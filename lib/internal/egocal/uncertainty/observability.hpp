// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/problem/problem.hpp"
#include "egocal/uncertainty/directions.hpp"

namespace egocal {

/// Whether the errors of near blocks may be related. If so, their correlations count as well
/// (docs/method.md): safer to report, noisier to compare settings by.
enum class ErrorCorrelation { correlated, independent };

/// When a direction counts as observable.
struct ObservabilityOptions {
  /// A direction of x y z roll pitch yaw is unobservable when more than this part of it lies in directions
  /// that the motions do not show: a twentieth leaves it 99.9 % of its information.
  double leak = 0.05;
  /// How far off the answer may be along a direction that the motions do not show, as a standard deviation:
  /// the part of such a direction that lies in an observable one adds to its standard deviation. A metre is
  /// the difference of heights on a vehicle (sensors tilted by 0.5 to 3 degrees on flat ground:
  /// docs/method.md).
  double unknown_translation = 1;  ///< [m]
  double unknown_rotation = 1;     ///< [rad]
  /// The same where the problem has a prior, which is taken there: a mounting drawing is known to this.
  double prior_translation = 0.1;  ///< [m]
  double prior_rotation = 0.05;    ///< [rad]
  /// How many times the curvature that independent rotation noise makes a translation needs. Three times is
  /// what the noise makes along the axis that the vehicle turns about.
  double independent_noise = 3;
  /// The same where the sensors may share their noise (one gyro), which the rotations cannot tell from
  /// motion. Of a correlation rho they see 1 - rho, and the curvature gets (3 + rho) / 3: 30 times covers
  /// 0.95. Up to there the translations must show the direction. Road drives of KITTI have 37 and more.
  double shared_noise = 30;
  /// Shared noise pulls a translation that is not shown to zero. One that differs from zero by this many
  /// standard deviations is shown: 1 false in 10,000.
  double shown_sigmas = 4;
  /// A hidden direction with a larger part of translation in it is a translation; rotations need no test for
  /// shared noise. A half: 30 degrees between the direction and the space of the rotations.
  double least_translation_part = 0.5;
  /// Part of a unit direction that must be translation (or rotation) for the hint to name it: what is within
  /// 17 degrees of the other kind is mixed into it by noise. Changes the advice only.
  double hinted_part = 0.3;
  /// A standard deviation needs at least this many blocks. With six, Student's factor is 1.31; with fewer it
  /// grows without bound (tests/bench/coverage_study.cpp).
  std::size_t least_blocks = 6;
  /// Largest correlation of neighbouring blocks: in 32 blocks, errors that last for longer than nine of them
  /// cannot be told from systematic ones.
  double most_correlation = 0.8;
  /// Blocks that are as concentrated as fewer equal ones than this have no spread; Student's factor would
  /// grow without bound.
  double least_equal_blocks = 2;
};

/// What the motions tell of each direction around the minimiser of (18), in the coordinates (t, rotation
/// vector) of sensor a's frame.
///
/// Observable: the curvature of the cost (the reduced Hessian T'ZT) is more than rounding, and more than the
/// noise of the motions alone makes: noisy rotations about one axis look like rotations about several.
/// Standard deviation: the block jack-knife, honest in spite of correlated motions. It is a variance: a
/// systematic error of one sensor stays. To it is added the attenuation that noisy rotations cause
/// (docs/method.md, "What cannot be known"). Errors that are compared as independent ones (settings of one
/// drive) are not asked whether the sensors share them. Planar mode: z, roll and pitch come from the planes;
/// they are not observable.
Observability assess_observability(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                   ErrorCorrelation errors = ErrorCorrelation::correlated,
                                   const ObservabilityOptions& options = {});

/// The observable directions alone, without the jack-knife.
std::array<bool, 6> observable_directions(const Problem& problem, const Matrix8d& Q,
                                          const DualQuaternion& T_a_b, ErrorCorrelation errors,
                                          const ObservabilityOptions& options = {});

/// Orthonormal basis (columns, t in units of length, rotation vector in radians, sensor a's frame) of some
/// directions.
struct DirectionBasis {
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, 6> basis;
  double length = 1;  ///< [m]
};
/// Directions that the motions do not show.
DirectionBasis hidden_directions(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                 ErrorCorrelation errors = ErrorCorrelation::correlated,
                                 const ObservabilityOptions& options = {});
/// Directions along which the cost is flat up to rounding: the minimum is not unique, any point along them is
/// one.
DirectionBasis flat_directions(const Matrix8d& Q, const DualQuaternion& T_a_b);

}  // namespace egocal
