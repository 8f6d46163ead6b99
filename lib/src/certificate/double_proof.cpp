// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "certificate/double_proof.hpp"

#include <cmath>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal::detail {

namespace {

constexpr int coordinates = 7;  // all of them but that of the answer

/// Numbers of two matrices side by side.
using Both = Eigen::Array2d;

bool positive(double x) {
  return x > 0;
}
bool positive(const Both& x) {
  return x[0] > 0 && x[1] > 0;
}

/// L D L' of the lower triangle with this taken off the diagonal; whether all pivots are positive.
template <typename Number>
bool has_positive_pivots(const LocalForm& form, const Number (&off)[coordinates]) {
  Number a[coordinates][coordinates];
  for (int j = 0; j < coordinates; ++j) {
    for (int i = j; i < coordinates; ++i) a[j][i] = Number(form(i, j));
    a[j][j] -= off[j];
  }
  for (int j = 0; j < coordinates; ++j) {
    if (!positive(a[j][j])) return false;
    const Number inverse = 1 / a[j][j];
    for (int k = j + 1; k < coordinates; ++k) {
      const Number scaled = a[j][k] * inverse;
      for (int i = k; i < coordinates; ++i) a[k][i] -= a[j][i] * scaled;
    }
  }
  return true;
}

/// What DoubleProof reads of a LocalForm, by quarters.
LocalForm local_form(const Square<8>& Q, const Column<8>& v, double bound, double orthogonal) {
  using Eigen::Matrix4d;
  Matrix4d A = Q.topLeftCorner<4, 4>(), B = Q.topRightCorner<4, 4>();
  const Matrix4d D = Q.bottomRightCorner<4, 4>();
  A.diagonal().array() -= bound;
  B.diagonal().array() += orthogonal;
  // T without its order: v and the turns are [R; S], (0, r) and the slides [0; R]
  const Matrix4d R = left_matrix(v.head<4>()), S = left_matrix(v.tail<4>());
  const Matrix4d of_slides = D.lazyProduct(R), lower = B.transpose().lazyProduct(R) + D.lazyProduct(S),
                 upper = A.lazyProduct(R) + B.lazyProduct(S);
  const Matrix4d R_transposed = R.transpose(), S_transposed = S.transpose();
  const Matrix4d slides = R_transposed.lazyProduct(of_slides), mixed = R_transposed.lazyProduct(lower),
                 turns = R_transposed.lazyProduct(upper) + S_transposed.lazyProduct(lower);
  LocalForm form;
  form.topLeftCorner<3, 3>() = turns.bottomRightCorner<3, 3>();
  form.block<3, 3>(3, 0) = mixed.bottomRightCorner<3, 3>();
  form.block<3, 3>(3, 3) = slides.bottomRightCorner<3, 3>();
  form.block<1, 3>(6, 0) = mixed.topRightCorner<1, 3>();
  form.block<1, 3>(6, 3) = slides.topRightCorner<1, 3>();
  form(6, 6) = slides(0, 0);
  form.block<3, 1>(0, 7) = turns.bottomLeftCorner<3, 1>();
  form.block<3, 1>(3, 7) = mixed.bottomLeftCorner<3, 1>();
  form(6, 7) = mixed(0, 0);
  return form;
}

}  // namespace

bool proven_in_double(const Square<8>& Q, const Column<8>& v, double cost, double bound, double orthogonal) {
  return DoubleProof(Q, v, cost, bound, orthogonal, local_form(Q, v, bound, orthogonal)).bound();
}

DoubleProof::DoubleProof(const Square<8>& Q, const Column<8>& v, double cost, double bound, double orthogonal,
                         const LocalForm& form)
    : form_(form) {
  constexpr double u = std::numeric_limits<double>::epsilon() / 2;
  const double last_place = static_cast<double>(extended_epsilon()), kappa = 512 * last_place;
  Extended rr = 0, rd = 0;
  double dd = 0;
  for (int i = 0; i < 4; ++i) {
    rr += static_cast<Extended>(v[i]) * v[i];
    rd += static_cast<Extended>(v[i]) * v[i + 4];
    dd += v[i + 4] * v[i + 4];
  }
  constexpr double slack = 1e-12;  // of |r|^2, much more than rounding
  if (!(std::abs(static_cast<double>(rr - 1)) <= slack)) return;
  const double tau = Q.norm() + 2 * std::abs(bound) + 3 * std::abs(orthogonal);
  if (!(tau >= 1e-100 && tau <= 1e100)) return;
  const double vv = 1 + dd;  // |v|^2 = t_i^2 of the rotations; t_i = |r| of the others

  double vEv = 0;
  for (int i = 0; i < 8; ++i) vEv += std::abs(Q(i, i) - (i < 4 ? bound : 0)) * v[i] * v[i];
  const double known = static_cast<double>(cost - bound * rr + 2 * orthogonal * rd);  // (1)
  const double alpha = known - 1.01 * u * std::abs(cost) - 32 * last_place * tau * vv - 2.01 * kappa * vEv;
  if (!(alpha > 0)) return;
  double along = 0;  // |D^-1 b|^2
  for (int i = 0; i < coordinates; ++i) {
    const double b = std::abs(form(i, 7)), t_squared = i < 3 ? vv : 1;
    const double error = 18 * u * tau;  // in parts of t_i |v|
    along += 2 * (b * b / t_squared + error * error * vv);
  }
  const double shift = (256 * u + 14 * kappa) * tau + along / alpha * (1 + 1e-9);  // (2), (3), (4), (6)
  constexpr double w = 1e-6;  // far below the part of a guess that is not tried, and above r'd in any answer
  square_ = 1 + 2 * w;
  orthogonal_ = 8 / w * static_cast<double>(rd * rd);
  shift_real_ = shift * vv;
  shift_dual_ = shift * (1 + 2 * slack);
  usable_ = true;
}

bool DoubleProof::bound() const {
  if (!usable_) return false;
  const double r = shift_real_, d = shift_dual_;
  return has_positive_pivots<double>(form_, {r, r, r, d, d, d, d});
}

bool DoubleProof::curvatures(const Curvatures& c) const {
  if (!usable_ || !(c.rotation >= 0 && c.translation >= 0)) return false;
  const Both r{shift_real_ + square_ * c.rotation, shift_real_ + orthogonal_ * c.translation};
  const Both t{shift_dual_, shift_dual_ + square_ * c.translation};
  const Both d = Both::Constant(shift_dual_);
  return has_positive_pivots<Both>(form_, {r, r, r, t, t, t, d});
}

}  // namespace egocal::detail
