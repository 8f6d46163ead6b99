// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "robust/residual_limit.hpp"

#include <algorithm>

#include "problem/motion_square.hpp"
#include "robust/excess.hpp"

namespace egocal {

double detail::excess_limit(std::uint64_t motions, const ConsensusOptions& options) {
  return options.limit_of_many +
         (options.limit_of_one - options.limit_of_many) / static_cast<double>(motions);
}

double detail::residual_limit(const Statistics& part, const Balance& balance, const ResidualScale& scale,
                              const ConsensusOptions& options) {
  const double size = detail::squared_size(cost_matrix(part, balance));
  return detail::excess_limit(part.count, options) *
         std::max(scale.absolute, size * std::max(scale.relative, options.least_relative));
}

double detail::disagreement(const DualQuaternion& a, const DualQuaternion& b, const Balance& balance,
                            const Agreement& agreement, const ConsensusOptions& options) {
  const double sign_a = positive_sign(a), sign_b = positive_sign(b);
  const QuaternionDifference real(a.real, sign_a, b.real, sign_b), dual(a.dual, sign_a, b.dual, sign_b);
  const double rotation = real.squared_size();
  const double size = balance.translation * dual.squared_size() + balance.rotation * rotation;
  if (!(size > 0)) return 0;
  const DualQuaternion& q = agreement.q;
  // summed in the order of disagreements()
  const auto squared_norm = [](const QuaternionVector& x) {
    return (x[0] * x[0] + x[2] * x[2]) + (x[1] * x[1] + x[3] * x[3]);
  };
  const double residual = balance.translation * squared_norm(dual.times(q.real) + real.times(q.dual)) +
                          balance.rotation * squared_norm(real.times(q.real));
  return detail::excess(residual, size, agreement.scale, options) / excess_limit(1, options);
}

double disagreement(const Statistics& part, const Balance& balance, const Agreement& agreement,
                    const ConsensusOptions& options) {
  const Matrix8d Q = cost_matrix(part, balance);
  const double size = detail::squared_size(Q);
  if (!(size > 0)) return 0;
  return detail::excess(std::max(0.0, cost(Q, agreement.q)), size, agreement.scale, options) /
         detail::excess_limit(part.count, options);
}

}  // namespace egocal
