// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "rig/remainder.hpp"

#include <cmath>

namespace egocal::detail::joint {

namespace {

/// At least the largest eigenvalue of a matrix whose entries are products of vectors: the eighth root of the
/// trace of its eighth power. `error` bounds the rounding of its trace.
double largest_eigenvalue(Matrix6 S, double error) {
  double trace = 0;
  for (std::size_t i = 0; i < 6; ++i) trace += S[i][i];
  if (!(trace > 0)) return error;
  for (auto& row : S)
    for (double& entry : row) entry /= trace;
  for (int power = 0; power < 3; ++power) {
    Matrix6 square{};
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j)
        for (std::size_t k = 0; k < 6; ++k) square[i][j] += S[i][k] * S[k][j];
    S = square;
  }
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) sum += S[i][i];
  // entries are at most 1 here: their rounding is far below 1e-12, and the sum at least 6^-7
  return upwards * trace * std::pow(sum + 1e-12, 0.125) + error;
}

/// The product x y of displacements a and b, in the pair's norm, is at most this times both lengths.
double bilinear_of(const Form& form, const std::array<Vector8, 6>& a, const std::array<Vector8, 6>& b) {
  // |sum y_k x_k y|^2 <= |y|^2 b'S b with S the sum over the directions of a
  Matrix6 S{};
  double error = 0;
  for (const Vector8& x : a) {
    std::array<Vector8, 6> product_of;
    const double xr = length(x, 0, 4), xd = length(x, 4, 8);
    for (std::size_t l = 0; l < 6; ++l) {
      product_of[l] = product(x, b[l]);
      // the product may cancel: its error is that of its factors
      const double yr = length(b[l], 0, 4), yd = length(b[l], 4, 8);
      const double real = xr * yr, dual = xr * yd + xd * yr;
      error += form.error_of(real, dual, real, dual);
    }
    for (std::size_t k = 0; k < 6; ++k)
      for (std::size_t l = 0; l <= k; ++l) S[k][l] = S[l][k] += form.at(product_of[k], product_of[l]);
  }
  // an error matrix of entries e_k e_l has the norm sum e_k^2
  return std::sqrt(largest_eigenvalue(S, error));
}

}  // namespace

double scalar_part(const Form& form, const Chart& chart, double c) {
  const double real = std::sqrt(form.at_most(real_one)), dual = std::sqrt(form.at_most(dual_one));
  return upwards * (real * chart.u * chart.u + dual * chart.u * chart.v / c);
}

double least_scalar(const Chart& chart, double radius) {
  const double u = chart.u * radius;
  return u < 1 ? std::sqrt(1 - u * u) / upwards : 0;
}

Remainder remainder_of(const Form& form, const Chart& a, const Chart& b, double radius) {
  const double c_a = least_scalar(a, radius), c_b = least_scalar(b, radius);
  const Vector8& m = form.m();
  const Vector8 back = {m[0], -m[1], -m[2], -m[3], m[4], -m[5], -m[6], -m[7]};
  // displacements of a as b sees them
  std::array<Vector8, 6> seen;
  double seen_curvature = 0, curvature = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    seen[k] = product(back, product(a.C[k], m));
    seen[k][0] = seen[k][4] = 0;
    seen_curvature += form.at_most(seen[k]);
    curvature += form.at_most(b.C[k]);
  }
  const double h = std::sqrt(form.dual_at_most());
  Remainder result;
  result.square_a = scalar_part(form, a, c_a);
  result.square_b = scalar_part(form, b, c_b);
  result.product = upwards * (bilinear_of(form, seen, b.C) +
                              radius * (a.u * a.u * std::sqrt(curvature) + h * a.u * a.v * b.u / c_a +
                                        b.u * b.u * std::sqrt(seen_curvature) + h * b.u * b.v * a.u / c_b));
  return result;
}

}  // namespace egocal::detail::joint
