// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/solvers/global.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "certificate/assess.hpp"
#include "egocal/problem/cost.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "solvers/newton.hpp"
#include "solvers/proven_dual.hpp"

namespace egocal {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// phi(m) and what belongs to it.
struct DualFunction {
  Matrix4d S0, S1, inverse;  ///< S(m) = S0 - m S1 - m^2 inverse
  Matrix4d B;
  double scale = 0;  ///< size of the numbers, for tolerances

  /// lift: added to D's diagonal, in parts of the scale. Where rotations are nearly noise-free D is nearly
  /// singular; the lift keeps the elimination finite, and what it changes is repaired by Newton steps on the
  /// true Q.
  DualFunction(const Matrix8d& Q, double lift) {
    scale = Q.trace();
    Matrix4d D = Q.bottomRightCorner<4, 4>();
    D.diagonal().array() += lift * scale;
    inverse = D.llt().solve(Matrix4d::Identity());
    B = Q.topRightCorner<4, 4>();
    const Matrix4d BD = B * inverse;
    S0 = Q.topLeftCorner<4, 4>() - BD * B.transpose();
    S1 = BD + BD.transpose();
  }

  Matrix4d at(double m) const { return S0 - m * S1 - m * m * inverse; }
  /// The d that minimises the Lagrangian for this r.
  Vector4d dual_part(const Vector4d& r, double m) const { return -(inverse * (B.transpose() * r + m * r)); }
};

/// Where phi has a kink its smallest eigenvalue is double, and the r in their span that has r'd = 0 is the
/// minimiser.
Vector4d orthogonal_combination(const DualFunction& phi, const Vector4d& r1, const Vector4d& r2, double m) {
  const double a = r1.dot(phi.dual_part(r1, m));
  const double c = r2.dot(phi.dual_part(r2, m));
  const double b = 0.5 * (r1.dot(phi.dual_part(r2, m)) + r2.dot(phi.dual_part(r1, m)));
  // a cos^2 + 2 b cos sin + c sin^2 = 0
  const double mean = 0.5 * (a + c);
  const double amplitude = std::hypot(0.5 * (a - c), b);
  if (!(amplitude > std::abs(mean))) return r1;
  const double phase = std::atan2(b, 0.5 * (a - c));
  const double angle = 0.5 * (phase + std::acos(-mean / amplitude));
  return std::cos(angle) * r1 + std::sin(angle) * r2;
}

/// The problem in scaled lengths, the best answer so far and the bound that proves it.
struct Search {
  Matrix8d Q;
  detail::Sizes sizes;
  bool symmetric = false;  ///< exactly: proofs read one triangle or both
  Solution best;
  std::optional<detail::ProvenBound> proven;
};

/// Whether it is proven that no unit dual quaternion is better than the best one by more than rounding.
bool proven_optimal(Search& search) {
  const Vector8d v = search.best.q.vec();
  const double rounding = detail::rounding_of<8>(search.sizes, v);
  const double cost = detail::extended_cost<8>(search.Q, v);
  const double bound = detail::first_proposal(cost, rounding), orthogonal = search.best.lambda.orthogonal;
  if ((search.symmetric && detail::proven_in_double(search.Q, v, cost, bound, orthogonal)) ||
      detail::proven_bound<8>(search.Q, bound, orthogonal, 0)) {
    search.proven = {bound, orthogonal};
    return true;
  }
  return std::abs(cost) <= rounding && detail::proven_sum_of_squares<8>(search.Q, search.sizes);
}

/// phi at one multiplier.
struct Sample {
  double m = 0, value = 0, slope = 0, curvature = 0;  ///< curvature: minus the second derivative
  Vector4d r, next;                                   ///< eigenvectors of the two smallest eigenvalues
};

Sample sample(const DualFunction& phi, double m) {
  const detail::SymmetricEigen<4> eigen = detail::symmetric_eigen<4>(phi.at(m));
  Sample here;
  here.m = m;
  here.value = eigen.values[0];
  here.r = eigen.vectors.col(0);
  here.next = eigen.vectors.col(1);
  here.slope = 2 * here.r.dot(phi.dual_part(here.r, m));
  const Vector4d change = phi.S1 * here.r + 2 * m * (phi.inverse * here.r);
  here.curvature = 2 * here.r.dot(phi.inverse * here.r);
  for (int k = 1; k < 4; ++k) {
    const double coupling = eigen.vectors.col(k).dot(change);
    here.curvature += 2 * coupling * coupling / std::max(eigen.values[k] - here.value, epsilon * phi.scale);
  }
  return here;
}

/// Runs Newton steps on the KKT system of the true Q from r and keeps the better answer. True: it is proven.
bool polish(Search& search, const DualFunction& phi, const Vector4d& r, double m) {
  Solution polished = detail::newton_on_kkt(search.Q, {r, phi.dual_part(r, m)});
  if (polished.cost < search.best.cost) {
    polished.iterations = search.best.iterations;
    search.best = polished;
  }
  return proven_optimal(search);
}

/// Ascent of the concave phi: Newton steps where it is smooth, the crossing of the tangents on both sides of
/// the maximum where it has a kink, halving where neither makes progress. Each time that less than `gain` (in
/// parts of the scale, ever smaller) is left to climb, Newton steps in the primal start from there; true as
/// soon as what they reach is proven.
bool ascend(Search& search, const DualFunction& phi, double gain) {
  Sample low, high;  // on the rising and on the falling side
  bool rising = false, falling = false;
  double m = 0, step = 0, width = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 60; ++i) {
    ++search.best.iterations;
    const Sample here = sample(phi, m);
    (here.slope > 0 ? rising : falling) = true;
    (here.slope > 0 ? low : high) = here;

    // at most this much above `here`
    double crossing = m;
    double left = 0.5 * here.slope * here.slope / here.curvature;
    bool pinned = false;
    if (rising && falling) {
      crossing =
          (high.value - low.value + low.slope * low.m - high.slope * high.m) / (low.slope - high.slope);
      left = low.value + low.slope * (crossing - low.m) - here.value;
      pinned = high.m - low.m <= 4 * epsilon * std::max(std::abs(low.m), std::abs(high.m));
    }
    const bool finished = pinned || left <= epsilon * phi.scale;
    if (finished || left <= gain * phi.scale) {
      if (polish(search, phi, here.r, m)) return true;
      if (finished) return polish(search, phi, orthogonal_combination(phi, here.r, here.next, m), m);
      gain *= 1e-4;
    }

    const double newton = m + here.slope / here.curvature;
    if (!rising || !falling) {
      // still on one side: at least twice as far as the last time
      const double wanted = newton - m;
      step = std::abs(wanted) > 2 * std::abs(step) ? wanted : 2 * step;
      m += step;
      continue;
    }
    const bool shrinking = high.m - low.m < 0.5 * width;
    width = high.m - low.m;
    if (i % 3 == 2 && !shrinking)
      m = 0.5 * (low.m + high.m);
    else if (i % 2 == 0 && newton > low.m && newton < high.m)
      m = newton;
    else
      m = crossing > low.m && crossing < high.m ? crossing : 0.5 * (low.m + high.m);
  }
  return false;
}

}  // namespace

detail::ProvenSolution detail::solve_dual_with_proof(const Matrix8d& Q_in) {
  ProvenSolution result;
  Solution& solution = result.solution;
  if (!Q_in.allFinite()) {
    solution.status = SolverStatus::not_finite;
    return result;
  }
  if (!(Q_in.diagonal().maxCoeff() > 0)) {
    solution.status = SolverStatus::degenerate;
    return result;
  }
  const double length = length_scale(Q_in);
  Search search;
  search.Q = in_units_of(length, Q_in);
  search.sizes = sizes_of<8>(search.Q);
  search.symmetric = search.Q == search.Q.transpose();
  search.best.cost = std::numeric_limits<double>::infinity();
  // The first attempt is nearly always the last. The others are for problems where Newton's basin is small or
  // D is nearly singular in a way that matters.
  constexpr struct {
    double lift, gain;
  } attempts[] = {{1e-9, 1e-4}, {1e-12, 1e-9}, {1e-6, 1e-9}, {64 * epsilon, 1e-12}};
  bool optimal = false;
  for (const auto& attempt : attempts) {
    optimal = ascend(search, DualFunction(search.Q, attempt.lift), attempt.gain);
    if (optimal) break;
  }
  if (!optimal) {
    // where D is singular the proof is another one
    const Subject<8> subject{search.Q, search.best.q.vec(), search.sizes, search.best.lambda.orthogonal};
    optimal = assess<8>(subject, {}).optimality == Optimality::certified;
  }
  solution = search.best;
  solution.status = optimal ? SolverStatus::converged : SolverStatus::iteration_limit;
  solution.q = in_units_of(1 / length, solution.q);
  solution.lambda = in_units_of(1 / length, solution.lambda);
  result.proven = search.proven;
  return result;
}

Solution solve_dual(const Matrix8d& Q) {
  return detail::solve_dual_with_proof(Q).solution;
}

}  // namespace egocal
