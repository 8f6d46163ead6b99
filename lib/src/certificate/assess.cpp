// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "certificate/assess.hpp"

#include <Eigen/Cholesky>

#include "problem/tangent.hpp"

namespace egocal::detail {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A basis in which a competitor differs from v: half rotations first, then half translations; then (0, r)
/// and v itself, which no extrinsic is free to choose and over which the form is minimised.
Eigen::Matrix<double, 8, 8> basis_at(const Column<8>& v) {
  const DualQuaternion q = DualQuaternion::from_vec(v);
  Eigen::Matrix<double, 8, 8> T;
  T << tangent_basis(q), Column<8>::Zero(), v;
  T.col(6).tail<4>() = q.real;
  return T;
}
Eigen::Matrix4d basis_at(const Column<4>& v) {
  Eigen::Matrix4d T;
  T << -v[1], 0, 0, v[0],       //
      v[0], 0, 0, v[1],         //
      v[3], v[0], -v[1], v[2],  //
      -v[2], v[1], v[0], v[3];
  return T;
}

/// T'ZT of this basis.
template <int N>
using Form = Eigen::Matrix<double, N, N>;
template <int N>
Form<N> form_at(const Square<N>& Q, const Column<N>& v, const ProvenBound& proven, double lift) {
  Square<N> Z = Q;
  for (int i = 0; i < N / 2; ++i) {
    Z(i, i) -= proven.bound;
    Z(i, i + N / 2) += proven.orthogonal;
    Z(i + N / 2, i) += proven.orthogonal;
    Z(i + N / 2, i + N / 2) += lift;
  }
  const auto T = basis_at(v);
  const auto ZT = Z.lazyProduct(T).eval();
  return T.transpose().lazyProduct(ZT);
}

/// A guess from the curvature in these directions, in double; it is to be proven.
template <int N>
Curvatures guessed_curvatures(const Subject<N>& subject, Form<N> M) {
  // degrees of freedom of the problem
  constexpr int rotations = N == 8 ? 3 : 1, translations = N == 8 ? 3 : 2, free = rotations + translations;
  for (int out = free; out < N; ++out) {
    if (!(M(out, out) > 0)) continue;
    const Eigen::Matrix<double, N, 1> column = M.col(out);
    M -= column * (column / column[out]).transpose();
  }
  Eigen::Matrix<double, free, free> H = M.template topLeftCorner<free, free>();
  // a curvature that rounding may have made positive is none
  const double d = subject.v.template tail<N / 2>().norm();
  const double size = subject.sizes.A + subject.sizes.D * (1 + 2 * d);
  H.diagonal().array() -= 16 * epsilon * size * size;
  const Eigen::LLT<Eigen::Matrix<double, free, free>> factor(H);
  if (factor.info() != Eigen::Success) return {};
  const Eigen::Matrix<double, free, free> inverse =
      factor.solve(Eigen::Matrix<double, free, free>::Identity());
  const double rotation = inverse.template topLeftCorner<rotations, rotations>().trace();
  const double translation = inverse.template bottomRightCorner<translations, translations>().trace();
  if (!(rotation > 0) || !(translation > 0) || !std::isfinite(rotation + translation)) return {};
  return {1 / rotation, 1 / translation};
}

template <int N>
Reach reach_of(const Subject<N>& subject, double cost, const ProvenBound& proven, double lift) {
  const Curvatures guess = guessed_curvatures<N>(subject, form_at<N>(subject.Q, subject.v, proven, lift));
  const Curvatures c =
      proven_curvatures<N>(subject.Q, subject.v, proven.bound, proven.orthogonal, lift, guess);
  return proven_reach<N>(subject.v, cost, proven.bound, lift, c);
}

/// The reach of an ordinary answer with this proposal of a bound, which it proves. What it does not prove may
/// be true.
template <int N>
std::optional<Reach> reach_in_double(const Subject<N>& subject, double cost, const ProvenBound& proposal) {
  if constexpr (N == 8) {
    const LocalForm form = form_at<N>(subject.Q, subject.v, proposal, 0);
    Curvatures c = guessed_curvatures<N>(subject, form);
    if (!(c.rotation > 0)) return std::nullopt;
    c.rotation *= parts_of_guess[0];
    c.translation *= parts_of_guess[0];
    const DoubleProof proof(subject.Q, subject.v, cost, proposal.bound, proposal.orthogonal, form);
    if (proof.curvatures(c)) return proven_reach<N>(subject.v, cost, proposal.bound, 0, c);
  }
  return std::nullopt;
}

/// Gap and verdict from the bound and the reach.
template <int N>
void conclude(const Subject<N>& subject, double bound, const Reach& reach, const CertificateOptions& options,
              Certificate& certificate) {
  certificate.lower_bound = std::min(bound, certificate.cost);
  certificate.gap = std::max(0.0, certificate.cost - bound);
  certificate.scaled_gap = certificate.rounding > 0 ? certificate.gap / certificate.rounding : 0;
  certificate.reach_translation = reach.translation;
  certificate.reach_rotation = reach.rotation;
  certificate.domain = reach.domain;
  const bool near =
      reach.translation <= options.reach_translation && reach.rotation <= options.reach_rotation;
  // far out along a flat direction rounding hides everything
  const double size = subject.sizes.A * subject.sizes.A + subject.sizes.D * subject.sizes.D;
  const bool meaningful = certificate.rounding <= options.largest_rounding * size;
  certificate.optimality = meaningful && (certificate.gap <= certificate.rounding || near)
                               ? Optimality::certified
                               : Optimality::undecided;
}

}  // namespace

template <int N>
void set_bound(const Subject<N>& subject, const ProvenBound& proven, const CertificateOptions& options,
               Certificate& certificate) {
  conclude(subject, proven.bound, reach_of(subject, certificate.cost, proven, 0), options, certificate);
}

template <int N>
Certificate assess(const Subject<N>& subject, const CertificateOptions& options,
                   const std::optional<ProvenBound>& known) {
  Certificate certificate;
  const double J = certificate.cost = extended_cost<N>(subject.Q, subject.v);
  const double rounding = certificate.rounding = rounding_of<N>(subject.sizes, subject.v);
  if (!(J >= -rounding) || !std::isfinite(J + rounding)) {
    // no cost matrix has a negative cost
    conclude(subject, -infinity, {}, options, certificate);
    certificate.optimality = Optimality::undecided;
    return certificate;
  }

  double bound = -infinity;
  Reach reach;
  const ProvenBound proposal = known ? *known : ProvenBound{first_proposal(J, rounding), subject.orthogonal};
  if (const auto at_once = reach_in_double(subject, J, proposal)) {
    bound = proposal.bound;
    reach = *at_once;
  } else if (const std::optional<ProvenBound> plain =
                 known ? known : best_bound<N>(subject.Q, J, rounding, subject.orthogonal, 0)) {
    bound = plain->bound;
    reach = reach_of(subject, J, *plain, 0);
  }
  if (bound < 0 && proven_sum_of_squares<N>(subject.Q, subject.sizes)) bound = 0;
  if (J - bound > rounding) {
    // D may be singular by rounding alone: the true one is at least the given one less `lift`
    // (docs/method.md, "Singular D"). With it the bound is one of J + lift |d|^2, and |d| of a competitor at
    // most |d_q| + |t| / 2.
    const double lift = 4 * epsilon * subject.Q.diagonal().template tail<N / 2>().maxCoeff();
    if (const auto lifted = best_bound<N>(subject.Q, J, rounding, subject.orthogonal, lift)) {
      const Reach near = reach_of(subject, J, *lifted, lift);
      const double d = subject.v.template tail<N / 2>().norm() + 0.5 * near.translation;
      const double charged = lifted->bound - lift * d * d;
      if (charged > bound) {
        bound = charged;
        reach = near;
      }
    }
  }
  conclude(subject, bound, reach, options, certificate);
  return certificate;
}

template Certificate assess<8>(const Subject<8>&, const CertificateOptions&,
                               const std::optional<ProvenBound>&);
template Certificate assess<4>(const Subject<4>&, const CertificateOptions&,
                               const std::optional<ProvenBound>&);
template void set_bound<8>(const Subject<8>&, const ProvenBound&, const CertificateOptions&, Certificate&);

}  // namespace egocal::detail
