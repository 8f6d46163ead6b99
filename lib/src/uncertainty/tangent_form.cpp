// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/tangent_form.hpp"

#include <limits>

#include "problem/wide_lanes.hpp"

#ifdef EGOCAL_WIDE_LANES
#include <immintrin.h>
#endif

// loops of a few numbers cost more than the arithmetic
#if defined(__GNUC__) && !defined(__clang__)
#define EGOCAL_STRAIGHT _Pragma("GCC unroll 21")
#else
#define EGOCAL_STRAIGHT
#endif

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
  // least_squares_multipliers() of q and the unit vectors
  const double rr = q.real.squaredNorm(), rd = q.real.dot(q.dual), all = rr + q.dual.squaredNorm();
  const double determinant = rr * all - rd * rd;
  for (int i = 0; i < 4; ++i) {
    const double r = q.real[i], d = q.dual[i];
    multipliers_.row(i) << (all * r - rd * d) / determinant, (rd * r - rr * d) / determinant;
    multipliers_.row(i + 4) << -rd * r / determinant, -rr * r / determinant;
  }
  numbers_.rotation = balance.rotation;
  numbers_.translation = balance.translation;
  for (int c = 0; c < 7; ++c)
    for (int i = 0; i < 4; ++i) {
      numbers_.upper[c][i] = upper_(i, c);
      numbers_.lower[c][i] = lower_(i, c);
    }
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) {
      numbers_.norm[j][i] = norm_(i, j);
      numbers_.orthogonal[j][i] = orthogonal_(i, j);
    }
  for (int i = 0; i < 4; ++i) {
    numbers_.norm_of_real[i] = multipliers_(i, 0);
    numbers_.norm_of_dual[i] = length_ * multipliers_(i + 4, 0);
    numbers_.orthogonal_of_real[i] = multipliers_(i, 1);
    numbers_.orthogonal_of_dual[i] = length_ * multipliers_(i + 4, 1);
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

namespace single {

using Number = double;

bool positive(double x) {
  return x > 0;
}

/// Place of an entry in a Matrix6d.
constexpr int place(int i, int j) {
  return 6 * j + i;
}

#include "uncertainty/factor_numbers.hpp"

}  // namespace single

/// Lanes of two numbers, for any processor.
namespace narrow {

#include "problem/lanes_of_two.hpp"

[[gnu::always_inline]] inline bool positive(const Lanes& x) {
  return x[0] > 0 && x[1] > 0;
}

#include "uncertainty/tangent_lanes.hpp"

}  // namespace narrow

#ifdef EGOCAL_WIDE_LANES
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

namespace wide {

#include "problem/lanes_of_four.hpp"

[[gnu::always_inline]] inline bool positive(const Lanes& x) {
  return _mm256_movemask_pd(_mm256_cmp_pd(x, _mm256_setzero_pd(), _CMP_GT_OQ)) == 15;
}

#include "uncertainty/tangent_lanes.hpp"

}  // namespace wide

#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

}  // namespace

bool factorise(Matrix6d& A, int n) {
  return n == 6 ? single::factorise_leading(A.data(), 6) : single::factorise_leading(A.data(), n);
}

void solve_factorised(const Matrix6d& factors, Vector6d& x, int n) {
  n == 6 ? single::solve_leading(factors.data(), x.data(), 6)
         : single::solve_leading(factors.data(), x.data(), n);
}

FourForms TangentSpace::forms(const std::array<const Statistics*, 4>& statistics,
                              [[maybe_unused]] bool in_pairs) const {
  FourForms result;
  const double* rows[FourForms::count];
  for (std::size_t k = 0; k < FourForms::count; ++k) rows[k] = statistics[k]->dual_rows.data();
  double *curvature = result.curvature.front().data(), *gradient = result.gradient.front().data();
#ifdef EGOCAL_WIDE_LANES
  if (!in_pairs && has_wide_lanes()) {
    wide::set_forms(numbers_, rows, curvature, gradient);
    return result;
  }
#endif
  for (int first = 0; first < 4; first += narrow::lane_count)
    narrow::set_forms(numbers_, rows + first, curvature + first, gradient + first);
  return result;
}

Fours<6> TangentSpace::newton_steps_without(const TangentForm& all, const FourForms& parts,
                                            [[maybe_unused]] bool in_pairs) {
  Fours<6> steps;
  double sum[21];  // the lower triangle
  for (int j = 0, k = 0; j < 6; ++j)
    for (int i = j; i < 6; ++i) sum[k++] = all.curvature(i, j);
  const double *sum_gradient = all.gradient.data(), *curvature = parts.curvature.front().data(),
               *gradient = parts.gradient.front().data();
  double* const to = steps.front().data();
  bool definite = true;
#ifdef EGOCAL_WIDE_LANES
  if (!in_pairs && has_wide_lanes())
    definite = wide::set_steps_without(sum, sum_gradient, curvature, gradient, to);
  else
#endif
    for (int first = 0; first < 4; first += narrow::lane_count)
      definite = definite && narrow::set_steps_without(sum, sum_gradient, curvature + first, gradient + first,
                                                       to + first);
  if (definite) return steps;
  for (std::size_t k = 0; k < FourForms::count; ++k) {
    const Vector6d step = newton_step(all - parts.form(k));
    for (int i = 0; i < 6; ++i) steps[static_cast<std::size_t>(i)][k] = step[i];
  }
  return steps;
}

Fours<6> sums_of_products(const FourForms& forms, const TriangleProducts& products,
                          [[maybe_unused]] bool in_pairs) {
  Fours<6> sums;
  const double* const curvature = forms.curvature.front().data();
  double* const to = sums.front().data();
#ifdef EGOCAL_WIDE_LANES
  if (!in_pairs && has_wide_lanes()) {
    wide::set_sums_of_products(curvature, products.data(), to);
    return sums;
  }
#endif
  for (int first = 0; first < 4; first += narrow::lane_count)
    narrow::set_sums_of_products(curvature + first, products.data(), to + first);
  return sums;
}

void FourForms::set(std::size_t k, const TangentForm& form) {
  std::size_t entry = 0;
  for (int j = 0; j < 6; ++j) {
    for (int i = j; i < 6; ++i) curvature[entry++][k] = form.curvature(i, j);
    gradient[static_cast<std::size_t>(j)][k] = form.gradient[j];
  }
}

TangentForm FourForms::form(std::size_t k) const {
  TangentForm form;
  std::size_t entry = 0;
  for (int j = 0; j < 6; ++j) {
    for (int i = j; i < 6; ++i) form.curvature(i, j) = form.curvature(j, i) = curvature[entry++][k];
    form.gradient[j] = gradient[static_cast<std::size_t>(j)][k];
  }
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

}  // namespace egocal::detail
