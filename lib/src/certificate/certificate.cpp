// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/certificate/certificate.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "certificate/proof.hpp"
#include "egocal/problem/cost.hpp"
#include "egocal/solvers/dual.hpp"
#include "egocal/solvers/planar.hpp"
#include "solvers/tangent.hpp"

namespace egocal {

namespace {

using detail::Column;
using detail::Extended;
using detail::proven_bound;
using detail::Square;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

template <int N>
double extended_cost(const Square<N>& Q, const Column<N>& v) {
  Extended sum = 0;
  for (int i = 0; i < N; ++i) {
    Extended row = 0;
    for (int j = 0; j < N; ++j) row += static_cast<Extended>(Q(i, j)) * v[j];
    sum += row * v[i];
  }
  return static_cast<double>(sum);
}

struct Reach {
  double translation = infinity;
  double rotation = infinity;
  double rotation_curvature = 0;  ///< least curvature of the cost over half the rotation vector
};

constexpr double farthest =
    1e4;  ///< where D is singular, extrinsics further apart than this are no competitors [m]

/// M minimised over the variable `out`; its row and column become zero.
template <int N>
void eliminate(Square<N>& M, int out) {
  const double pivot = M(out, out);
  if (pivot > 0) {
    const Column<N> column = M.col(out);
    M.noalias() -= column * (column / pivot).transpose();
  }
  M.row(out).setZero();
  M.col(out).setZero();
}

/// How far p = q^-1 q' can be from the identity if x'Hx <= gap (docs/method.md, "Reach"), x = half the
/// rotation vector (first Rot) and half the translation (the rest). H is known up to
/// `noise`.
template <int N, int Rot>
Reach reach_within(Square<N> H, double gap, double noise) {
  Reach reach;
  H.diagonal().array() -= noise;
  const Eigen::LLT<Square<N>> factor(H);
  if (factor.info() != Eigen::Success) return reach;
  const Square<N> inverse = factor.solve(Square<N>::Identity());
  const double rotation = inverse.template topLeftCorner<Rot, Rot>().trace();
  const double translation = inverse.template bottomRightCorner<N - Rot, N - Rot>().trace();
  if (!(rotation > 0) || !(translation >= 0) || !std::isfinite(rotation + translation)) return reach;
  reach.rotation_curvature = 1 / rotation;
  const double sine = std::sqrt(gap * rotation);  // bounds |p_v| = sin(angle / 2)
  if (!(sine < 0.9)) return reach;
  reach.rotation = 2 * std::asin(sine);
  // |t|^2 - (t . p_v)^2 = |2 p_dv|^2
  reach.translation = 2 * std::sqrt(gap * translation / (1 - sine * sine));
  return reach;
}

/// Fills bound, gap, reach and the verdict. lambda is a proposal: whatever it is, the bound is proven.
template <int N>
struct Verifier {
  const Square<N>& Q;
  Column<N> v;

  double rounding() const { return detail::rounding_of<N>(Q, v); }
  /// Where D is singular up to rounding: the true D is not smaller than the given one by more than this.
  double lift() const { return 4 * epsilon * Q.diagonal().template tail<N / 2>().maxCoeff(); }

  /// The largest of a few proposals below `value` that can be proven; nothing proven gives -infinity.
  double best_bound(double value, double orthogonal, double lifted) const {
    for (const double step : {0.25, 0.9, 16.0, 256.0, 4096.0, 65536.0}) {
      const double bound = value - step * rounding();
      if (proven_bound<N>(Q, bound, orthogonal, lifted)) return bound;
    }
    return -infinity;
  }
};

void set_bound(double bound, const Reach& reach, double trace, const CertificateOptions& options,
               Certificate& certificate) {
  certificate.lower_bound = std::min(bound, certificate.cost);
  certificate.gap = std::max(0.0, certificate.cost - bound);
  certificate.scaled_gap = certificate.rounding > 0 ? certificate.gap / certificate.rounding : 0;
  certificate.reach_translation = reach.translation;
  certificate.reach_rotation = reach.rotation;
  const bool near =
      reach.translation <= options.reach_translation && reach.rotation <= options.reach_rotation;
  // far out along a flat direction rounding hides everything
  const bool meaningful = certificate.rounding <= options.largest_rounding * trace;
  certificate.optimality = meaningful && (certificate.gap <= certificate.rounding || near)
                               ? Optimality::certified
                               : Optimality::undecided;
}

/// Bound, gap, reach and whether that certifies. reach_for(gap, lift) is the reach of competitors whose cost
/// above the bound is at most the gap.
template <int N, class ReachFunction>
void decide(const Verifier<N>& verifier, const CertificateOptions& options, const ReachFunction& reach_for,
            Certificate& certificate) {
  const double J = certificate.cost;
  const double m = certificate.lambda.orthogonal;
  double bound = 0;  // J is a sum of squares
  Reach reach;
  const double plain = verifier.best_bound(J, m, 0);
  if (std::isfinite(plain)) {
    bound = std::max(bound, plain);
    reach = reach_for(J - plain, 0);
  }
  if (J - bound > certificate.rounding) {
    // D may be singular by rounding alone: the true one is at least the given one less `lift`. With the lift
    // the bound holds for J + lift |d|^2, and |d| of a competitor is at most |d_q| + reach / 2
    // (docs/method.md, "Singular D").
    const double lift = verifier.lift();
    const double lifted = verifier.best_bound(J, m, lift);
    if (std::isfinite(lifted)) {
      const double d = verifier.v.template tail<N / 2>().norm();
      const double gap = J - lifted + 2 * lift * d * d;
      const Reach near = reach_for(gap, lift);
      const double charge = lift * std::pow(d + 0.5 * near.translation, 2);
      const bool far_excluded = 0.81 * near.rotation_curvature > gap + 0.5 * lift * farthest * farthest;
      if (far_excluded && near.translation < farthest && lifted - charge > bound) {
        bound = lifted - charge;
        reach = near;
      }
    }
  }
  set_bound(bound, reach, verifier.Q.trace(), options, certificate);
}

/// Reach of competitors in 3-D: Z seen from q, minimised over q's own direction and that of (0, r), which no
/// rigid displacement is free to choose.
Reach spatial_reach(const Matrix8d& Q, const DualQuaternion& q, const Multipliers& lambda, double gap,
                    double lift) {
  const Matrix8d basis = left_matrix(q);
  Matrix8d Z = lagrangian_matrix(Q, lambda);
  Z.diagonal().tail<4>().array() += lift;
  Matrix8d M = basis.transpose() * Z * basis;
  const Matrix8d size = basis.cwiseAbs().transpose() * (Z.cwiseAbs() * basis.cwiseAbs());
  eliminate<8>(M, 4);
  eliminate<8>(M, 0);
  Square<6> H;
  H << M.block<3, 3>(1, 1), M.block<3, 3>(1, 5), M.block<3, 3>(5, 1), M.block<3, 3>(5, 5);
  // at |p_v| <= 0.9 a competitor's |p_d|^2 is at most 5.3 |p_dv|^2; twice that times the lift is not
  // curvature
  H.diagonal().tail<3>().array() -= 11 * lift;
  return reach_within<6, 3>(H, gap, 16 * epsilon * size.diagonal().maxCoeff());
}

/// The four variables that (26) leaves, q1, q4, q6, q7, of a problem in 3-D.
constexpr std::array<int, 4> planar_variables = {0, 3, 5, 6};

Square<4> planar_part(const Matrix8d& Q) {
  Square<4> part;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      part(i, j) =
          Q(planar_variables[static_cast<std::size_t>(i)], planar_variables[static_cast<std::size_t>(j)]);
  return part;
}

Column<4> planar_part(const DualQuaternion& q) {
  const Column<4> part(q.real[0], q.real[3], q.dual[1], q.dual[2]);
  return part / part.head<2>().norm();
}

/// Reach of competitors in the plane: seen from v, yaw and two translations.
Reach planar_reach(const Square<4>& Q, const Column<4>& v, double bound, double gap, double lift) {
  Square<4> basis;
  basis << v[0], -v[1], 0, 0,   //
      v[1], v[0], 0, 0,         //
      v[2], v[3], v[0], -v[1],  //
      v[3], -v[2], v[1], v[0];
  Square<4> Z = Q;
  Z.diagonal().head<2>().array() -= bound;
  Z.diagonal().tail<2>().array() += lift;
  Square<4> M = basis.transpose() * Z * basis;
  const Square<4> size = basis.cwiseAbs().transpose() * (Z.cwiseAbs() * basis.cwiseAbs());
  eliminate<4>(M, 0);
  Square<3> H = M.bottomRightCorner<3, 3>();
  H.diagonal().tail<2>().array() -= 11 * lift;
  return reach_within<3, 1>(H, gap, 16 * epsilon * size.diagonal().maxCoeff());
}

Certificate not_finite() {
  Certificate certificate;
  certificate.cost = certificate.gap = certificate.scaled_gap = infinity;
  certificate.lower_bound = -infinity;
  certificate.reach_translation = certificate.reach_rotation = infinity;
  return certificate;
}

/// From lengths in `length` back to metres.
Certificate in_metres(Certificate certificate, double length) {
  certificate.reach_translation *= length;
  certificate.lambda = detail::in_units_of(1 / length, certificate.lambda);
  return certificate;
}

}  // namespace

double cost_rounding(const Matrix8d& Q, const DualQuaternion& q) {
  return detail::rounding_of<8>(Q, q.vec());
}

Certificate verify(const Matrix8d& Q_in, const DualQuaternion& q_in, const CertificateOptions& options_in) {
  const DualQuaternion unit = normalized(q_in);
  if (!Q_in.allFinite() || !unit.vec().allFinite()) return not_finite();
  const double length = detail::length_scale(Q_in);
  const Matrix8d Q = detail::in_units_of(length, Q_in);
  const DualQuaternion q = detail::in_units_of(length, unit);
  CertificateOptions options = options_in;
  options.reach_translation /= length;

  Certificate certificate;
  const Verifier<8> verifier{Q, q.vec()};
  certificate.cost = extended_cost<8>(Q, verifier.v);
  certificate.rounding = verifier.rounding();
  certificate.lambda = least_squares_multipliers(Q, q);
  const auto reach_for = [&](double gap, double lift) {
    return spatial_reach(Q, q, {certificate.cost - gap, certificate.lambda.orthogonal}, gap, lift);
  };
  decide<8>(verifier, options, reach_for, certificate);
  if (certificate.optimality == Optimality::certified) return in_metres(certificate, length);

  // The multiplier of (28) proves little when q is no stationary point. The dual's own multiplier does
  // better, and its primal, if it is better than q by more than rounding, disproves q.
  const Solution best = solve_dual(Q);
  const Verifier<8> best_verifier{Q, best.q.vec()};
  const double better = extended_cost<8>(Q, best_verifier.v);
  const double proven = best_verifier.best_bound(better, best.lambda.orthogonal, 0);
  if (proven > certificate.lower_bound) {
    certificate.lambda.orthogonal = best.lambda.orthogonal;
    set_bound(proven, reach_for(certificate.cost - proven, 0), Q.trace(), options, certificate);
  }
  if (certificate.optimality != Optimality::certified && better < certificate.cost - certificate.rounding)
    certificate.optimality = Optimality::not_optimal;
  return in_metres(certificate, length);
}

Certificate verify_planar(const Matrix8d& Q_in, const DualQuaternion& T_p,
                          const CertificateOptions& options_in) {
  if (!Q_in.allFinite() || !T_p.vec().allFinite()) return not_finite();
  const double length = detail::length_scale(Q_in);
  const Square<4> Q = planar_part(detail::in_units_of(length, Q_in));
  const Column<4> v = planar_part(detail::in_units_of(length, T_p));
  CertificateOptions options = options_in;
  options.reach_translation /= length;

  Certificate certificate;
  const Verifier<4> verifier{Q, v};
  certificate.cost = extended_cost<4>(Q, v);
  certificate.rounding = verifier.rounding();
  certificate.lambda = {v.head<2>().dot(Q.topRows<2>() * v), 0};
  const auto reach_for = [&](double gap, double lift) {
    return planar_reach(Q, v, certificate.cost - gap, gap, lift);
  };
  decide<4>(verifier, options, reach_for, certificate);
  if (certificate.optimality == Optimality::certified) return in_metres(certificate, length);

  const double better = extended_cost<4>(Q, planar_part(detail::in_units_of(length, solve_planar(Q_in).q)));
  if (better < certificate.cost - certificate.rounding) certificate.optimality = Optimality::not_optimal;
  return in_metres(certificate, length);
}

}  // namespace egocal
