// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/distributions.hpp"

#include <cmath>

namespace egocal::detail {

namespace {

/// ln Gamma by Lanczos (g = 7, n = 9): std::lgamma writes a global variable. x > 0.
double log_gamma(double x) {
  constexpr double coefficients[] = {0.99999999999980993,  676.5203681218851,     -1259.1392167224028,
                                     771.32342877765313,   -176.61502916214059,   12.507343278686905,
                                     -0.13857109526572012, 9.9843695780195716e-6, 1.5056327351493116e-7};
  constexpr double half_log_two_pi = 0.91893853320467274178;  // mathematics
  double sum = coefficients[0];
  for (int i = 1; i < 9; ++i) sum += coefficients[i] / (x - 1 + i);
  const double t = x + 6.5;
  return half_log_two_pi + (x - 0.5) * std::log(t) - t + std::log(sum);
}

/// The continued fraction of the incomplete beta function (modified Lentz).
double beta_fraction(double x, double a, double b) {
  constexpr double tiny = 1e-300;  // far below any term: no division by zero
  const auto away_from_zero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1;
  double d = 1 / away_from_zero(1 - (a + b) * x / (a + 1));
  double h = d;
  for (int m = 1; m <= 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / away_from_zero(1 + even * d);
    c = away_from_zero(1 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / away_from_zero(1 + odd * d);
    c = away_from_zero(1 + odd / c);
    const double factor = d * c;
    h *= factor;
    if (std::abs(factor - 1) < 1e-14) break;
  }
  return h;
}

/// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double x, double a, double b) {
  if (!(x > 0)) return 0;
  if (!(x < 1)) return 1;
  const double front =
      std::exp(log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(x, a, b) / a;
  return 1 - front * beta_fraction(1 - x, b, a) / b;
}

}  // namespace

double f_exceeded(double f, double d1, double d2) {
  if (!(f > 0) || !(d1 > 0) || !(d2 > 0)) return 1;
  if (!std::isfinite(f)) return 0;
  return incomplete_beta(d2 / (d2 + d1 * f), 0.5 * d2, 0.5 * d1);
}

double student_factor(double freedom) {
  const double x = 1 / freedom;
  return 1 + x * (1.2104 + x * (1.440 + x * 1.304));
}

double hotelling_exceeded(double t2, double p, double nu) {
  const double d2 = nu - p + 1;
  return f_exceeded(t2 * d2 / (nu * p), p, d2);
}

}  // namespace egocal::detail
