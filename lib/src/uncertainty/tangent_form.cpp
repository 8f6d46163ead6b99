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

namespace {

/// Numbers of two problems side by side.
using Both = Eigen::Array2d;

bool positive(double x) {
  return x > 0;
}
bool positive(const Both& x) {
  return x[0] > 0 && x[1] > 0;
}

/// n: a number that is known when this is compiled makes straight code of the loops.
template <typename Number, typename N>
bool factorise_leading(Number* const a, N n) {
  for (int j = 0; j < n; ++j) {
    const Number pivot = a[7 * j];
    if (!positive(pivot)) return false;
    const Number inverse = 1 / pivot;
    for (int k = j + 1; k < n; ++k) {
      const Number scaled = a[6 * j + k] * inverse;
      for (int i = k; i < n; ++i) a[6 * k + i] -= a[6 * j + i] * scaled;
      a[6 * j + k] = scaled;
    }
    a[7 * j] = inverse;
  }
  return true;
}

template <typename Number, typename N>
void solve_leading(const Number* const a, Number* const x, N n) {
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
  return n == 6 ? factorise_leading(A.data(), All()) : factorise_leading(A.data(), n);
}

void solve_factorised(const Matrix6d& factors, Vector6d& x, int n) {
  n == 6 ? solve_leading(factors.data(), x.data(), All()) : solve_leading(factors.data(), x.data(), n);
}

/// As form(), number by number: matrices of two problems have no packets of their own.
std::array<TangentForm, 2> TangentSpace::forms(const Statistics& first, const Statistics& second) const {
  if (!starts_with_translations_) return {form(first), form(second)};
  const Matrix8d &x = first.dual_rows, &y = second.dual_rows;
  const double rotation = balance_.rotation, translation = balance_.translation;
  Both A[4][4], B[4][4], D[4][4];
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const Both real{x(i + 4, j + 4), y(i + 4, j + 4)};
      A[i][j] = translation * Both{x(i, j), y(i, j)} + rotation * real;
      B[i][j] = translation * Both{x(i, j + 4), y(i, j + 4)};
      D[i][j] = translation * real;
    }
  const auto &U = upper_, &L = lower_;
  Both upper[4][7], lower[4][7];  // S [T, q]; the translations' columns of the upper one are not needed
  for (int i = 0; i < 4; ++i)
    for (int c = 0; c < 7; ++c) {
      lower[i][c] = D[i][0] * L(0, c) + D[i][1] * L(1, c) + D[i][2] * L(2, c) + D[i][3] * L(3, c);
      if (c < 3) continue;
      lower[i][c] += B[0][i] * U(0, c) + B[1][i] * U(1, c) + B[2][i] * U(2, c) + B[3][i] * U(3, c);
      upper[i][c] = B[i][0] * L(0, c) + B[i][1] * L(1, c) + B[i][2] * L(2, c) + B[i][3] * L(3, c);
      upper[i][c] += A[i][0] * U(0, c) + A[i][1] * U(1, c) + A[i][2] * U(2, c) + A[i][3] * U(3, c);
    }
  Both norm = Both::Zero(), orthogonal = Both::Zero();
  for (int i = 0; i < 4; ++i) {
    norm += multipliers_(i, 0) * upper[i][6] + length_ * multipliers_(i + 4, 0) * lower[i][6];
    orthogonal += multipliers_(i, 1) * upper[i][6] + length_ * multipliers_(i + 4, 1) * lower[i][6];
  }
  std::array<TangentForm, 2> result;
  const auto product = [&](int row, int column) {
    Both sum = L(0, row) * lower[0][column] + L(1, row) * lower[1][column] + L(2, row) * lower[2][column] +
               L(3, row) * lower[3][column];
    if (row >= 3)
      sum += U(0, row) * upper[0][column] + U(1, row) * upper[1][column] + U(2, row) * upper[2][column] +
             U(3, row) * upper[3][column];
    return sum;
  };
  for (int j = 0; j < 6; ++j) {
    for (int i = j; i < 6; ++i) {
      // T'ST is symmetric: the rows of the translations are the shorter ones
      const Both sum = i >= 3 && j < 3 ? product(j, i) : product(i, j);
      const Both curvature = sum - norm * norm_(i, j) + orthogonal * orthogonal_(i, j);
      for (std::size_t k = 0; k < 2; ++k)
        result[k].curvature(i, j) = result[k].curvature(j, i) = curvature[static_cast<Eigen::Index>(k)];
    }
    const Both gradient = product(j, 6);
    for (std::size_t k = 0; k < 2; ++k) result[k].gradient[j] = gradient[static_cast<Eigen::Index>(k)];
  }
  return result;
}

std::array<Vector6d, 2> TangentSpace::newton_steps_without(const TangentForm& all, const TangentForm& first,
                                                           const TangentForm& second) {
  std::array<Both, 36> factors;  // the lower triangle
  std::array<Both, 6> x;
  for (int j = 0; j < 6; ++j)
    for (int i = j; i < 6; ++i)
      factors[static_cast<std::size_t>(6 * j + i)] =
          all.curvature(i, j) - Both{first.curvature(i, j), second.curvature(i, j)};
  for (int i = 0; i < 6; ++i)
    x[static_cast<std::size_t>(i)] = -(all.gradient[i] - Both{first.gradient[i], second.gradient[i]});
  if (!factorise_leading(factors.data(), All())) return {newton_step(all - first), newton_step(all - second)};
  solve_leading(factors.data(), x.data(), All());
  std::array<Vector6d, 2> steps;
  for (int i = 0; i < 6; ++i) {
    steps[0][i] = x[static_cast<std::size_t>(i)][0];
    steps[1][i] = x[static_cast<std::size_t>(i)][1];
  }
  return steps;
}

Vector6d TangentSpace::newton_step(const TangentForm& form, int directions) {
  Matrix6d factors = form.curvature;
  if (!factorise(factors, directions)) return Vector6d::Constant(std::numeric_limits<double>::infinity());
  Vector6d step = -form.gradient;
  for (int i = directions; i < 6; ++i) step[i] = 0;
  solve_factorised(factors, step, directions);
  return step;
}

}  // namespace egocal::detail
