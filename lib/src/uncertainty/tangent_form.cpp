// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/tangent_form.hpp"

#include <limits>

namespace egocal::detail {

TangentSpace::TangentSpace(const DualQuaternion& q, double length, const Matrix86d& tangent,
                           const Balance& balance)
    : q_(q), balance_(balance), tangent_(tangent), length_(length) {
  upper_ << tangent.topRows<4>(), q.real;
  lower_ << length * tangent.bottomRows<4>(), length * q.dual;
  tangent_upper_ = upper_.leftCols<6>().transpose();
  tangent_lower_ = lower_.leftCols<6>().transpose();
  const Eigen::Matrix<double, 4, 6> real = tangent.topRows<4>(), dual = tangent.bottomRows<4>();
  norm_ = real.transpose() * real;
  orthogonal_ = real.transpose() * dual;
  orthogonal_ += Matrix6d(orthogonal_.transpose());
}

TangentForm TangentSpace::form(const Statistics& statistics) const {
  using Matrix47 = Eigen::Matrix<double, 4, 7>;
  const Eigen::Matrix4d A = balance_.translation * statistics.dual_rows.topLeftCorner<4, 4>() +
                            balance_.rotation * statistics.dual_rows.bottomRightCorner<4, 4>();
  const Eigen::Matrix4d B = balance_.translation * statistics.dual_rows.topRightCorner<4, 4>();
  const Eigen::Matrix4d D = balance_.translation * statistics.dual_rows.bottomRightCorner<4, 4>();
  Matrix47 upper = A.lazyProduct(upper_), lower = B.transpose().lazyProduct(upper_);
  upper += B.lazyProduct(lower_);
  lower += D.lazyProduct(lower_);
  TangentForm form;
  form.curvature = tangent_upper_.lazyProduct(upper.leftCols<6>());
  form.curvature += tangent_lower_.lazyProduct(lower.leftCols<6>());
  form.gradient << upper.col(6), length_ * lower.col(6);
  return form;
}

Matrix6d TangentSpace::curvature(const TangentForm& form) const {
  const Multipliers lambda = least_squares_multipliers(q_, form.gradient);
  return form.curvature - lambda.norm * norm_ + lambda.orthogonal * orthogonal_;
}

Vector6d TangentSpace::newton_step(const TangentForm& form, int directions) const {
  Matrix6d factors = curvature(form);
  if (!factorise(factors, directions)) return Vector6d::Constant(std::numeric_limits<double>::infinity());
  Vector6d step = -tangent_.transpose().lazyProduct(form.gradient);
  for (int i = directions; i < 6; ++i) step[i] = 0;
  solve_factorised(factors, step, directions);
  return step;
}

bool factorise(Matrix6d& A, int n) {
  for (int j = 0; j < n; ++j) {
    const double pivot = A(j, j);
    if (!(pivot > 0)) return false;
    const double inverse = 1 / pivot;
    for (int k = j + 1; k < n; ++k) {
      const double scaled = A(k, j) * inverse;
      for (int i = k; i < n; ++i) A(i, k) -= A(i, j) * scaled;
      A(k, j) = scaled;
    }
    A(j, j) = inverse;
  }
  return true;
}

void solve_factorised(const Matrix6d& factors, Vector6d& x, int n) {
  for (int j = 0; j < n; ++j)
    for (int i = j + 1; i < n; ++i) x[i] -= factors(i, j) * x[j];
  for (int j = n - 1; j >= 0; --j) {
    x[j] *= factors(j, j);
    for (int i = j + 1; i < n; ++i) x[j] -= factors(i, j) * x[i];
  }
}

}  // namespace egocal::detail
