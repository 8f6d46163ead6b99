// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "verification/verify.hpp"

#include "certificate/assess.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/problem/cost.hpp"
#include "egocal/solvers/global.hpp"
#include "problem/tangent.hpp"

namespace egocal {

namespace {

using detail::Column;
using detail::ProvenBound;
using detail::Sizes;
using detail::Square;
using detail::Subject;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// An answer may be off a unit dual quaternion by this much, as numbers that were written and read are; it is
/// normalised then.
constexpr double unit_tolerance = 1e-6;

bool is_extrinsic(const DualQuaternion& q) {
  return q.vec().allFinite() && std::abs(q.real.norm() - 1) <= unit_tolerance &&
         std::abs(q.real.dot(q.dual)) <= unit_tolerance * q.dual.norm();
}

/// Whether Q is finite, far from underflow and overflow, and symmetric up to rounding: the proof reads one
/// triangle.
bool is_usable(const Matrix8d& Q) {
  if (!Q.allFinite()) return false;
  const double largest = Q.diagonal().cwiseAbs().maxCoeff();
  if (largest == 0) return Q.isZero(0);
  if (!(largest > 1e-250 && largest < 1e250)) return false;
  const Sizes sizes = detail::sizes_of<8>(Q);
  const auto size = [&](int i) { return i < 4 ? sizes.A : sizes.D; };
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < i; ++j)
      if (!(std::abs(Q(i, j) - Q(j, i)) <= detail::known_to * size(i) * size(j))) return false;
  return true;
}

Certificate refused() {
  Certificate certificate;
  certificate.cost = certificate.gap = certificate.scaled_gap = infinity;
  certificate.lower_bound = -infinity;
  certificate.reach_translation = certificate.reach_rotation = infinity;
  return certificate;
}

/// Options and certificate, from metres to `length` and back.
CertificateOptions in_units_of(double length, CertificateOptions options) {
  options.reach_translation /= length;
  return options;
}
Certificate in_metres(Certificate certificate, double length) {
  certificate.reach_translation *= length;
  certificate.domain *= length;
  certificate.lambda = detail::in_units_of(1 / length, certificate.lambda);
  return certificate;
}

/// The four variables that (26) leaves, q1, q4, q6, q7, of a problem in 3-D.
constexpr std::array<int, 4> planar_variables = {0, 3, 5, 6};

Square<4> planar_part(const Matrix8d& Q) {
  Square<4> part;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      part(static_cast<int>(i), static_cast<int>(j)) = Q(planar_variables[i], planar_variables[j]);
  return part;
}

Column<4> planar_part(const DualQuaternion& q) {
  const Column<4> part(q.real[0], q.real[3], q.dual[1], q.dual[2]);
  return part / part.head<2>().norm();
}

bool is_planar(const DualQuaternion& q) {
  const double rest = std::hypot(q.real[1], q.real[2]), rest_dual = std::hypot(q.dual[0], q.dual[3]);
  return rest <= unit_tolerance && rest_dual <= unit_tolerance * (1 + q.dual.norm());
}

/// Q with both triangles alike; the cost of every q stays what it is.
Matrix8d symmetric(const Matrix8d& Q) {
  return 0.5 * (Q + Q.transpose());
}

}  // namespace

Certificate detail::verify(const Matrix8d& Q_in, const DualQuaternion& q_in,
                           const CertificateOptions& options_in, const std::optional<ProvenBound>& proven) {
  if (!is_usable(Q_in) || !is_extrinsic(q_in)) return refused();
  const double length = length_scale(Q_in);
  const Matrix8d Q = in_units_of(length, symmetric(Q_in));
  const DualQuaternion q = in_units_of(length, unit_to_rounding(q_in) ? q_in : normalized(q_in));
  const CertificateOptions options = egocal::in_units_of(length, options_in);

  const Multipliers lambda = least_squares_multipliers(Q, q);
  const Subject<8> subject{Q, q.vec(), sizes_of<8>(Q), lambda.orthogonal};
  Certificate certificate = assess<8>(subject, options, proven);
  certificate.lambda = lambda;
  if (certificate.optimality == Optimality::certified || !(certificate.cost >= -certificate.rounding))
    return in_metres(certificate, length);

  // The multiplier of (28) proves little when q is no stationary point. The dual's own multiplier does
  // better, and its primal, if it is better than q by more than rounding, disproves q.
  const Solution best = solve_dual(Q);
  const double better = extended_cost<8>(Q, best.q.vec());
  const double rounding = rounding_of<8>(subject.sizes, best.q.vec());
  const auto bound = best_bound<8>(Q, better, rounding, best.lambda.orthogonal, 0);
  if (bound && bound->bound > certificate.lower_bound) {
    certificate.lambda.orthogonal = best.lambda.orthogonal;
    set_bound<8>(subject, *bound, options, certificate);
  }
  if (certificate.optimality != Optimality::certified && better < certificate.cost - certificate.rounding)
    certificate.optimality = Optimality::not_optimal;
  return in_metres(certificate, length);
}

Certificate verify(const Matrix8d& Q, const DualQuaternion& q, const CertificateOptions& options) {
  return detail::verify(Q, q, options, std::nullopt);
}

Certificate verify_planar(const Matrix8d& Q_in, const DualQuaternion& T_p,
                          const CertificateOptions& options_in) {
  if (!is_usable(Q_in) || !is_extrinsic(T_p) || !is_planar(T_p)) return refused();
  const double length = detail::length_scale(Q_in);
  const Matrix8d Q_all = detail::in_units_of(length, symmetric(Q_in));
  const CertificateOptions options = in_units_of(length, options_in);
  const Subject<4> subject{planar_part(Q_all), planar_part(detail::in_units_of(length, T_p)),
                           detail::sizes_of<8>(Q_all), 0};
  Certificate certificate = detail::assess<4>(subject, options);
  certificate.lambda = {subject.v.head<2>().dot(subject.Q.topRows<2>() * subject.v), 0};
  if (certificate.optimality == Optimality::certified || !(certificate.cost >= -certificate.rounding))
    return in_metres(certificate, length);

  const DualQuaternion best = detail::in_units_of(length, solve_planar(Q_in).q);
  const double better = detail::extended_cost<4>(subject.Q, planar_part(best));
  if (better < certificate.cost - certificate.rounding) certificate.optimality = Optimality::not_optimal;
  return in_metres(certificate, length);
}

}  // namespace egocal
