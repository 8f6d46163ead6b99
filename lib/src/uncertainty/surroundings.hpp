// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "egocal/uncertainty/observability.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

/// What the curvature of the cost shows around the minimiser. Lengths in units of `length` [m].
struct Surroundings {
  double length = 1, pairs = 0;
  DualQuaternion q;
  Matrix86d tangent;                        ///< frame_a_basis() of q
  Matrix6d H;                               ///< reduced Hessian
  double noise = 0;                         ///< rotation_noise()
  Matrix6d vectors = Matrix6d::Identity();  ///< columns: directions, `hidden` ones that are not seen first
  int hidden = 0;

  auto hidden_vectors() const { return vectors.leftCols(hidden); }
};

/// Rotation noise in D: without noise r'Dr is zero; noise that is independent of sensor and motion adds it to
/// D alike in every direction.
double rotation_noise(const Matrix8d& Q, const DualQuaternion& q);

/// A rotation of the answer about a line that the motions do not show, in sensor a's frame; lengths in units
/// of `length`.
struct HiddenTurn {
  Eigen::Vector3d axis;  ///< unit vector
  Eigen::Vector3d arm;   ///< from the line to the origin of sensor b, across the axis
  double rotation_part;  ///< of the unit hidden direction
};

/// The rotations among the hidden directions: those that differ from hidden translations by more than noise
/// mixes into them. Empty if all rotations are seen.
std::vector<HiddenTurn> hidden_turns(const Surroundings& around, const ObservabilityOptions& options);

/// A turn that is hidden may be wrong by any angle, so a coordinate must hardly change anywhere along it. The
/// tangent at the minimiser does not tell: where the arm points along x, it is along y alone.
/// Settings of one drive are compared without this test, since they have the same unknown part.
std::array<bool, 6> observable_around(const Surroundings& around, ErrorCorrelation errors,
                                      const ObservabilityOptions& options);

/// Variances of the coordinates where the answer is somewhere along hidden turns. `variance`: of the
/// directions that are seen, around the minimiser. A turn takes their errors to other coordinates across the
/// axis. Without a prior no angle is more likely than others: then a rotation vector, seen from an answer
/// that is off by the angle alpha, is (alpha / 2) / sin(alpha / 2) as large, whose square is 2 ln 2 in the
/// mean. lengths: of a unit of the turns in that of the variance.
Vector6d with_hidden_turns(const std::vector<HiddenTurn>& turns, Vector6d variance, double lengths,
                           bool has_prior, const ObservabilityOptions& options);

/// Variance that errors along the hidden directions add to the coordinates with a part in them: the
/// covariance of errors that are independent in each coordinate, restricted to these directions.
Vector6d variance_of_hidden(const Surroundings& around, bool has_prior, const ObservabilityOptions& options);

/// Rotation noise pulls the translation towards where it costs least, by the part of D that is noise, and the
/// rotation with it where both are seen together. t: of the minimiser, in sensor a's axes and units of
/// length; seen: columns, the directions that are seen.
Vector6d pull_of_noise(const Surroundings& around, const Eigen::Vector3d& t,
                       const Eigen::Ref<const Eigen::Matrix<double, 6, Eigen::Dynamic>>& seen);

/// The translation of q, in units of the length of q.
Eigen::Vector3d translation_of(const DualQuaternion& q);

}  // namespace egocal::detail
