// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "rig/chart.hpp"

#include <cmath>

namespace egocal::detail::joint {

namespace {

/// Part of a guessed curvature that is to be proven.
constexpr double guess_part = 0.9;

constexpr std::array<std::size_t, 6> imaginary = {1, 2, 3, 5, 6, 7};

/// H over (u, v) when p0 and e, which no displacement is free to choose, are minimised over.
Matrix6 reduced_hessian(const Form& form) {
  std::array<Vector8, 8> basis{};
  basis[0] = real_one;
  basis[1] = dual_one;
  for (std::size_t i = 0; i < 6; ++i) basis[i + 2][imaginary[i]] = 1;
  std::array<std::array<double, 8>, 8> M;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k <= i; ++k) M[i][k] = M[k][i] = form.at(basis[i], basis[k]);
  for (std::size_t out = 0; out < 2; ++out) {
    if (!(M[out][out] > 0)) continue;
    for (std::size_t i = out + 1; i < 8; ++i)
      for (std::size_t k = out + 1; k < 8; ++k) M[i][k] -= M[i][out] * M[out][k] / M[out][out];
  }
  Matrix6 H;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 6; ++k) H[i][k] = M[i + 2][k + 2];
  return H;
}

/// C with C'HC = 1, upper triangular: the inverse of H's Cholesky factor. Empty where H is not positive.
std::optional<Matrix6> whitening(Matrix6 H) {
  Matrix6 L{}, inverse{}, C{};
  for (std::size_t j = 0; j < 6; ++j) {
    double pivot = H[j][j];
    for (std::size_t k = 0; k < j; ++k) pivot -= L[j][k] * L[j][k];
    if (!(pivot > 0) || !std::isfinite(pivot)) return std::nullopt;
    L[j][j] = std::sqrt(pivot);
    for (std::size_t i = j + 1; i < 6; ++i) {
      double sum = H[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
      L[i][j] = sum / L[j][j];
    }
  }
  for (std::size_t j = 0; j < 6; ++j) {
    inverse[j][j] = 1 / L[j][j];
    for (std::size_t i = j + 1; i < 6; ++i) {
      double sum = 0;
      for (std::size_t k = j; k < i; ++k) sum -= L[i][k] * inverse[k][j];
      inverse[i][j] = sum / L[i][i];
    }
  }
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) C[i][j] = inverse[j][i];
  return C;
}

/// Proves p'Mp >= |y|^2 for every p = p0 + eps e + C y, by the factorisation of the form in these variables.
bool proven_chart(const Form& form, const Chart& chart) {
  std::array<Vector8, 8> column{};
  column[0] = real_one;
  column[1] = dual_one;
  for (std::size_t i = 0; i < 6; ++i) column[i + 2] = chart.C[i];
  ExtendedSquare<8> N;
  std::array<double, 8> diagonal{};
  for (std::size_t i = 0; i < 8; ++i) diagonal[i] = form.at(column[i], column[i]);
  // variables of like size: the errors of a row are charged to its diagonal
  std::array<double, 8> scale;
  for (std::size_t i = 0; i < 8; ++i)
    scale[i] = i < 2 && diagonal[i] > 0 ? std::exp2(-std::round(0.5 * std::log2(diagonal[i]))) : 1;
  for (std::size_t i = 0; i < 8; ++i) {
    double error = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      N[i][k] = static_cast<Extended>(scale[i] * scale[k]) * form.at(column[i], column[k]);
      error += scale[i] * scale[k] * form.error_of(column[i], column[k]);
    }
    N[i][i] -= upwards * error + (i < 2 ? 0.0 : 1.0);
  }
  return proven_semidefinite<8>(N);
}

}  // namespace

std::optional<Chart> chart_of(const Form& form) {
  Matrix6 H = reduced_hessian(form);
  for (auto& row : H)
    for (double& entry : row) entry *= guess_part;
  const std::optional<Matrix6> C = whitening(H);
  if (!C) return std::nullopt;
  Chart chart;
  double u = 0, v = 0;
  for (std::size_t j = 0; j < 6; ++j) {
    chart.C[j] = {};
    for (std::size_t i = 0; i < 6; ++i) chart.C[j][imaginary[i]] = (*C)[i][j];
    u += std::pow(length(chart.C[j], 0, 4), 2);
    v += std::pow(length(chart.C[j], 4, 8), 2);
  }
  chart.u = upwards * std::sqrt(u);
  chart.v = upwards * std::sqrt(v);
  if (!std::isfinite(chart.u + chart.v) || !proven_chart(form, chart)) return std::nullopt;
  return chart;
}

}  // namespace egocal::detail::joint
