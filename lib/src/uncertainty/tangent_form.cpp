// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/tangent_form.hpp"

#include <limits>
#include <type_traits>

namespace egocal::detail {

TangentSpace::TangentSpace(const DualQuaternion& q, double length, const Matrix86d& tangent,
                           const Balance& balance)
    : balance_(balance), length_(length) {
  upper_ << tangent.topRows<4>(), q.real;
  lower_ << length * tangent.bottomRows<4>(), length * q.dual;
  starts_with_translations_ = upper_.leftCols<3>().isZero(0);
  tangent_upper_ = upper_.leftCols<6>().transpose();
  tangent_lower_ = lower_.leftCols<6>().transpose();
  const Eigen::Matrix<double, 4, 6> real = tangent.topRows<4>(), dual = tangent.bottomRows<4>();
  norm_ = real.transpose() * real;
  orthogonal_ = real.transpose() * dual;
  orthogonal_ += Matrix6d(orthogonal_.transpose());
  for (int i = 0; i < 8; ++i) {
    const Multipliers lambda = least_squares_multipliers(q, Vector8d::Unit(i));
    multipliers_.row(i) << lambda.norm, lambda.orthogonal;
  }
}

TangentForm TangentSpace::form(const Statistics& statistics) const {
  using Matrix47 = Eigen::Matrix<double, 4, 7>;
  const Eigen::Matrix4d A = balance_.translation * statistics.dual_rows.topLeftCorner<4, 4>() +
                            balance_.rotation * statistics.dual_rows.bottomRightCorner<4, 4>();
  const Eigen::Matrix4d B = balance_.translation * statistics.dual_rows.topRightCorner<4, 4>();
  const Eigen::Matrix4d D = balance_.translation * statistics.dual_rows.bottomRightCorner<4, 4>();
  // S [T, q], then T' S [T, q]
  Matrix47 upper = B.lazyProduct(lower_), lower = D.lazyProduct(lower_);
  upper.rightCols<4>() += A.lazyProduct(upper_.rightCols<4>());
  lower.rightCols<4>() += B.transpose().lazyProduct(upper_.rightCols<4>());
  if (!starts_with_translations_) {
    upper.leftCols<3>() += A.lazyProduct(upper_.leftCols<3>());
    lower.leftCols<3>() += B.transpose().lazyProduct(upper_.leftCols<3>());
  }
  Eigen::Matrix<double, 6, 7> product = tangent_lower_.lazyProduct(lower);
  product += tangent_upper_.lazyProduct(upper);
  const Eigen::Vector2d lambda = multipliers_.topRows<4>().transpose().lazyProduct(upper.col(6)) +
                                 length_ * multipliers_.bottomRows<4>().transpose().lazyProduct(lower.col(6));
  TangentForm form;
  form.curvature = product.leftCols<6>() - lambda[0] * norm_ + lambda[1] * orthogonal_;
  form.gradient = product.col(6);
  return form;
}

Vector6d TangentSpace::newton_step(const TangentForm& form, int directions) {
  Matrix6d factors = form.curvature;
  if (!factorise(factors, directions)) return Vector6d::Constant(std::numeric_limits<double>::infinity());
  Vector6d step = -form.gradient;
  for (int i = directions; i < 6; ++i) step[i] = 0;
  solve_factorised(factors, step, directions);
  return step;
}

namespace {

/// n: a number that is known when this is compiled makes straight code of the loops.
template <typename N>
bool factorise_leading(Matrix6d& A, N n) {
  double* const a = A.data();
  for (int j = 0; j < n; ++j) {
    const double pivot = a[7 * j];
    if (!(pivot > 0)) return false;
    const double inverse = 1 / pivot;
    for (int k = j + 1; k < n; ++k) {
      const double scaled = a[6 * j + k] * inverse;
      for (int i = k; i < n; ++i) a[6 * k + i] -= a[6 * j + i] * scaled;
      a[6 * j + k] = scaled;
    }
    a[7 * j] = inverse;
  }
  return true;
}

template <typename N>
void solve_leading(const Matrix6d& factors, Vector6d& x, N n) {
  const double* const a = factors.data();
  for (int j = 0; j < n; ++j)
    for (int i = j + 1; i < n; ++i) x[i] -= a[6 * j + i] * x[j];
  for (int j = n - 1; j >= 0; --j) {
    x[j] *= a[7 * j];
    for (int i = j + 1; i < n; ++i) x[j] -= a[6 * j + i] * x[i];
  }
}

using All = std::integral_constant<int, 6>;

}  // namespace

bool factorise(Matrix6d& A, int n) {
  return n == 6 ? factorise_leading(A, All()) : factorise_leading(A, n);
}

void solve_factorised(const Matrix6d& factors, Vector6d& x, int n) {
  n == 6 ? solve_leading(factors, x, All()) : solve_leading(factors, x, n);
}

}  // namespace egocal::detail
