// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "rig/pair_form.hpp"

#include "egocal/problem/cost.hpp"

namespace egocal::detail::joint {

namespace {

/// A pair's bound is proven this far below its minimum, as a part of it: where the bound meets the minimum
/// the form is singular and rounding decides. It costs the certificate its root, a thousandth of the noise.
constexpr double bound_slack = 1e-6;

Vector8 to_array(const DualQuaternion& q) {
  Vector8 v;
  for (int i = 0; i < 4; ++i) {
    v[static_cast<std::size_t>(i)] = q.real[i];
    v[static_cast<std::size_t>(i) + 4] = q.dual[i];
  }
  return v;
}

}  // namespace

Form::Form(const JointPair& pair, const std::vector<DualQuaternion>& poses)
    : m_(to_array(relative(poses[pair.a], poses[pair.b]))),
      lever_(poses[pair.a].dual.norm() + poses[pair.b].dual.norm()) {
  lambda_ = least_squares_multipliers(pair.Q, pair.optimum);
  minimum_ = cost(pair.Q, pair.optimum);
  set(pair.Q, 0);
  const double slack = bound_slack * minimum_ + 64 * error_of(1, 0, 1, 0);
  lambda_.norm = minimum_ - slack;
  set(pair.Q, lambda_.norm);
}

void Form::set(const Matrix8d& Q, double bound) {
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 8; ++k) Z_[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = Q(i, k);
  for (std::size_t i = 0; i < 4; ++i) {
    Z_[i][i] -= bound;
    Z_[i][i + 4] += lambda_.orthogonal;
    Z_[i + 4][i] += lambda_.orthogonal;
  }
  const auto norm = [&](std::size_t row, std::size_t column) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 4; ++k) sum += Z_[row + i][column + k] * Z_[row + i][column + k];
    return std::sqrt(sum);
  };
  size_rr_ = norm(0, 0);
  size_rd_ = norm(0, 4);
  size_dd_ = norm(4, 4);
}

}  // namespace egocal::detail::joint
