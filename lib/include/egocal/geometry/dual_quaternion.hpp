// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "egocal/geometry/pose.hpp"

namespace egocal {

// Unaligned: their layout does not depend on compile flags (egocal/layout.hpp).
using Vector8d = Eigen::Matrix<double, 8, 1, Eigen::DontAlign>;
using Matrix8d = Eigen::Matrix<double, 8, 8, Eigen::DontAlign>;
/// A quaternion as a vector, always in the order w, x, y, z.
using QuaternionVector = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;
using QuaternionMatrix = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;

QuaternionVector quaternion_product(const QuaternionVector& p, const QuaternionVector& q);
QuaternionVector quaternion_conjugate(const QuaternionVector& q);
/// vec(p q) = left_matrix(p) q, and vec(p q) = right_matrix(q) p.
QuaternionMatrix left_matrix(const QuaternionVector& p);
QuaternionMatrix right_matrix(const QuaternionVector& q);

/// q = real + eps dual (1), each w, x, y, z; a unit one (5) is a rigid displacement (7).
struct DualQuaternion {
  QuaternionVector real = QuaternionVector::UnitX();
  QuaternionVector dual = QuaternionVector::Zero();  ///< 1/2 t real [m]

  /// vec(q) of (11).
  Vector8d vec() const;
  static DualQuaternion from_vec(const Vector8d& q);
};
EGOCAL_SAME_LAYOUT(DualQuaternion)

DualQuaternion operator*(const DualQuaternion& p, const DualQuaternion& q);  ///< (9)
DualQuaternion operator-(const DualQuaternion& q);                           ///< the same displacement
DualQuaternion conjugate(const DualQuaternion& q);  ///< (2), the inverse of a unit one
Matrix8d left_matrix(const DualQuaternion& p);      ///< Q_p^l of (10)
Matrix8d right_matrix(const DualQuaternion& q);     ///< Q_q^r of (10)

/// The nearest unit dual quaternion: real scaled to length one, dual made orthogonal to it (5). All NaN where
/// there is none (real part zero, not finite, or its length outside of 1e-100 to 1e100), so that no check
/// behind it is misled.
DualQuaternion normalized(const DualQuaternion& q);
/// Returns q or -q, whichever has a real scalar >= 0 (for a half turn: a first non-zero real part > 0).
DualQuaternion canonical_sign(const DualQuaternion& q);

DualQuaternion to_dual_quaternion(const Pose& T);  ///< (6), (7); canonical sign
Pose to_pose(const DualQuaternion& q);             ///< of the normalised q

/// Angle of the rotation that a unit quaternion of either sign is, in [0, pi] [rad].
double rotation_angle(const QuaternionVector& q);
double rotation_angle(const DualQuaternion& q);
/// Length of the translation of a unit dual quaternion [m].
double translation_length(const DualQuaternion& q);

/// The screw of a motion: it turns by angle about an axis and slides by pitch along it. Every pair of motions
/// of two rigidly mounted sensors has the same angle and slide (screw congruence), whatever the extrinsic.
struct Screw {
  double angle = 0;  ///< [0, pi] [rad]
  double slide = 0;  ///< along the axis [m]; the length of the translation where the angle is 0
};
Screw screw_of(const DualQuaternion& q);

/// Screw linear interpolation from p (s = 0) to q (s = 1), the shorter way round.
DualQuaternion interpolate(const DualQuaternion& p, const DualQuaternion& q, double s);

}  // namespace egocal
