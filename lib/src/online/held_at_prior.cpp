// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "online/held_at_prior.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "linear_algebra/symmetric_eigen.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

using Axes = std::vector<Eigen::Vector3d>;

/// A rotation about a line, in the frame of sensor a.
struct Turn {
  Eigen::Vector3d axis;
  Eigen::Vector3d arm;  ///< from the line to the origin of sensor b, across the axis [m]
};

struct Hidden {
  Axes translations;  ///< unit vectors
  std::vector<Turn> turns;
};

/// Pure translations that the hidden directions contain, and what remains as rotations about lines: a small
/// part of the other kind is noise, and a finite step along a mixed direction would leave the flat set.
Hidden taken_apart(const DirectionBasis& directions, const HoldOptions& options) {
  Hidden result;
  const auto& basis = directions.basis;
  const SymmetricEigen<3> parts =
      symmetric_eigen<3>(Eigen::Matrix3d(basis.topRows<3>() * basis.topRows<3>().transpose()));
  Matrix6d rest = basis * basis.transpose();
  for (int k = 2; k >= 0 && parts.values[k] > options.mostly_translation; --k) {
    result.translations.emplace_back(parts.vectors.col(k));
    Vector6d along = Vector6d::Zero();
    along.head<3>() = parts.vectors.col(k);
    const Vector6d inside = rest * along / std::sqrt(along.dot(rest * along));
    rest -= inside * inside.transpose();
  }
  const SymmetricEigen<6> left = symmetric_eigen<6>(rest);
  const auto turns = static_cast<int>(basis.cols()) - static_cast<int>(result.translations.size());
  for (int k = 5; k > 5 - turns; --k) {
    const Eigen::Vector3d rotation = left.vectors.col(k).tail<3>();
    const Eigen::Vector3d moment = left.vectors.col(k).head<3>() * directions.length / rotation.norm();
    const Eigen::Vector3d axis = rotation.normalized();
    result.turns.push_back({axis, moment.cross(axis)});
  }
  return result;
}

/// Angle about the axis that brings `from` closest to `to`.
double angle_towards(const Rotation& from, const Rotation& to, const Eigen::Vector3d& axis) {
  const Rotation between = to * from.conjugate();
  const double angle = 2 * std::atan2(between.vec().dot(axis), between.w());
  return std::remainder(angle, 2 * std::numbers::pi);
}

/// p p' of a square (p'q)^2.
Matrix8d square_of(const Eigen::Vector4d& real, const Eigen::Vector4d& dual) {
  Vector8d p;
  p << real, dual;
  return p * p.transpose();
}

Eigen::Vector4d vector_part(const Eigen::Vector3d& v) {
  return {0, v.x(), v.y(), v.z()};
}

}  // namespace

std::optional<HeldCost> held_at_prior(const Matrix8d& Q, const DualQuaternion& minimiser,
                                      const DualQuaternion& prior, const DirectionBasis& directions,
                                      const HoldOptions& options) {
  const Hidden hidden = taken_apart(directions, options);
  const Pose wanted = to_pose(prior);
  Pose T = to_pose(minimiser);
  double moved = 0;
  const int sweeps = hidden.turns.size() > 1 ? options.sweeps : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const Turn& turn : hidden.turns) {
      const double angle = angle_towards(T.rotation, wanted.rotation, turn.axis);
      const Rotation rotation = rotation_exp(angle * turn.axis);
      T = {(rotation * T.rotation).normalized(), T.translation + (rotation * turn.arm - turn.arm)};
      moved = std::max(moved, std::abs(angle));
    }
  for (const Eigen::Vector3d& along : hidden.translations) {
    const double distance = along.dot(wanted.translation - T.translation);
    T.translation += distance * along;
    moved = std::max(moved, std::abs(distance));
  }
  if (!(moved > options.there)) return std::nullopt;

  HeldCost result{Q, to_dual_quaternion(T)};
  const Eigen::Vector4d r = result.start.real;
  // with n across: (n r)'r_q is the sine of half the angle to r
  const double turning = options.stiffness * Q.topLeftCorner<4, 4>().trace();
  for (const Turn& turn : hidden.turns)
    result.Q += turning * square_of(quaternion_product(vector_part(turn.axis), r), Eigen::Vector4d::Zero());
  // t = 2 d r*, so (n r)'d is half the translation along n
  const double shifting = options.stiffness * Q.bottomRightCorner<4, 4>().trace();
  for (const Eigen::Vector3d& along : hidden.translations)
    result.Q +=
        shifting * square_of(-0.5 * along.dot(T.translation) * r, quaternion_product(vector_part(along), r));
  return result;
}

}  // namespace egocal::detail
