// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The information of motions that leave no residual, by moments of their parts.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "linear_algebra/cross_matrix.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

/// Sums of products of the vector parts r and d of the real and dual halves of motions of sensor a.
struct MotionProducts {
  Eigen::Matrix3d rr = Eigen::Matrix3d::Zero(), rd = rr, dd = rr;

  /// Rotated by less than half a turn.
  void add(const Pose& motion) {
    const Eigen::Vector3d r = motion.rotation.vec(),
                          d = 0.5 * (motion.rotation.w() * motion.translation + motion.translation.cross(r));
    rr += r * r.transpose();
    rd += r * d.transpose();
    dd += d * d.transpose();
  }
};

/// |x|^2 I - x x' from the sum of x x', and the like of two vectors.
inline Eigen::Matrix3d squared_cross(const Eigen::Matrix3d& products) {
  return products.trace() * Eigen::Matrix3d::Identity() - products.transpose();
}

/// Sum of the information of motions a that leave no residual. With b = x^-1 a x the residual of (1 + e) x is
/// c x with c = e a - a e, whatever b is, and e = (dtheta, v) / 2, v = dt + t x dtheta. So c is (dtheta x r,
/// v x r + dtheta x d), and its dual half with x is |c_d|^2 + c_d . (c_r x t) + |c_r|^2 |t|^2 / 4.
inline Matrix6d information_of(const MotionProducts& sums, const Eigen::Vector3d& t, const Balance& balance) {
  const Eigen::Matrix3d square = squared_cross(sums.rr), T = cross_matrix(t);
  const Eigen::Vector3d turned(sums.rd(2, 1) - sums.rd(1, 2), sums.rd(0, 2) - sums.rd(2, 0),
                               sums.rd(1, 0) - sums.rd(0, 1));                             // sum of d x r
  const Eigen::Matrix3d mixed = squared_cross(sums.rd) - 0.5 * cross_matrix(sums.rr * t);  // of v and dtheta
  const Eigen::Matrix3d of_turn = squared_cross(sums.dd) +
                                  0.5 * (turned * t.transpose() + t * turned.transpose()) +
                                  0.25 * t.squaredNorm() * square;
  const Eigen::Matrix3d beside = mixed + square * T;  // of dt and dtheta
  Matrix6d information;
  information << square, beside, beside.transpose(), of_turn + T.transpose() * beside + mixed.transpose() * T;
  information *= balance.translation;
  information.bottomRightCorner<3, 3>() += balance.rotation * square;
  return information;
}

}  // namespace egocal::detail
