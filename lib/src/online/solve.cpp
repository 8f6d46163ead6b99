// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "egocal/online/answer.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/solvers/sdp.hpp"
#include "egocal/solvers/slsqp.hpp"
#include "egocal/solvers/sqp.hpp"
#include "egocal/uncertainty/observability.hpp"
#include "online/held_at_prior.hpp"
#include "online/solve_and_verify.hpp"
#include "solvers/proven_dual.hpp"
#include "uncertainty/frame_a.hpp"
#include "verification/verify.hpp"

namespace egocal {

namespace {

struct Stopwatch {
  NanosecondClock clock;
  std::int64_t now() const { return clock ? clock() : 0; }
};

/// Minimises by the method. Local methods without a start begin at the global minimum, which costs less than
/// they do; a poor start could end in a local minimum.
detail::ProvenSolution minimise(const Matrix8d& Q, Method method,
                                const std::optional<DualQuaternion>& start) {
  const auto begin = [&] { return start ? *start : solve_dual(Q).q; };
  switch (method) {
    case Method::dual:
      return detail::solve_dual_with_proof(Q);
    case Method::sdp:
      return {solve_sdp(Q), {}};
    case Method::sqp:
      return {solve_sqp(Q, begin()), {}};
    case Method::slsqp:
      return {solve_slsqp(Q, begin()), {}};
  }
  return {};
}

/// The extrinsic closest to the prior among all equally good ones: follows the directions in which the cost
/// is flat up to rounding, as long as it does not rise. The set may be curved (rotation about a common axis),
/// hence the steps.
DualQuaternion nearest_to_prior(const Matrix8d& Q, const DualQuaternion& minimiser,
                                const DualQuaternion& prior) {
  DualQuaternion q = minimiser;
  const double least = cost(Q, q);
  for (int i = 0; i < 50; ++i) {
    const DirectionBasis flat = flat_directions(Q, q);
    if (flat.basis.cols() == 0) return q;
    detail::Vector6d wish = detail::frame_a_difference(q, prior);
    wish.head<3>() /= flat.length;
    detail::Vector6d step = flat.basis * (flat.basis.transpose() * wish);
    // small steps in rotation, as the flat set is curved
    const double turn = step.tail<3>().norm();
    if (turn > 0.3) step *= 0.3 / turn;
    const double size = step.norm();
    step.head<3>() *= flat.length;
    DualQuaternion next = detail::frame_a_moved(q, step);
    next = solve_sqp(Q, next).q;
    if (!(cost(Q, next) <= least + cost_rounding(Q, next))) return q;
    q = next;
    if (size < 1e-9) return q;
  }
  return q;
}

Answer solve_spatial(const Problem& problem, const Matrix8d& Q, Method method,
                     const std::optional<DualQuaternion>& start, const Stopwatch& time) {
  Answer answer;
  answer.method = method;
  const std::int64_t begin = time.now();
  const auto [solution, proven] = minimise(Q, method, start);
  answer.solve_ns = time.now() - begin;
  answer.status = solution.status;
  answer.T_a_b = solution.q;
  const DualQuaternion prior = problem.prior.value_or(DualQuaternion{});
  if (solution.status == SolverStatus::degenerate || !(Q.diagonal().maxCoeff() > 0))
    answer.T_a_b = canonical_sign(normalized(prior));
  else if (solution.status != SolverStatus::not_finite)
    answer.T_a_b = nearest_to_prior(Q, solution.q, prior);
  const std::int64_t verified = time.now();
  const bool moved = answer.T_a_b.vec() != solution.q.vec();
  answer.certificate = detail::verify(Q, answer.T_a_b, {}, moved ? std::nullopt : proven);
  answer.verify_ns = time.now() - verified;
  return answer;
}

Answer solve_in_plane(const Problem& problem, const Matrix8d& Q, Method method,
                      const std::optional<DualQuaternion>& start, const Stopwatch& time) {
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  Answer answer;
  answer.method = method;
  const std::int64_t begin = time.now();
  const auto begin_in_plane = [&] {
    return start ? planar_from_extrinsic(*start, G_a, G_b) : solve_planar(Q).q;
  };
  const Solution solution =
      method == Method::slsqp ? solve_slsqp_planar(Q, begin_in_plane()) : solve_planar(Q);
  answer.solve_ns = time.now() - begin;
  answer.status = solution.status;
  DualQuaternion T_p = solution.q;
  const DualQuaternion prior = planar_from_extrinsic(problem.prior.value_or(DualQuaternion{}), G_a, G_b);
  if (solution.status == SolverStatus::degenerate) {
    T_p = prior;
  } else if (!(Q.block<2, 2>(5, 5).trace() > 1e-28 * (Q(0, 0) + Q(3, 3)))) {
    // nothing turned: the translation is free
    const Pose free_translation = to_pose(prior);
    T_p = to_dual_quaternion({to_pose(T_p).rotation, free_translation.translation});
  }
  const std::int64_t verified = time.now();
  answer.certificate = verify_planar(Q, T_p);
  answer.verify_ns = time.now() - verified;
  answer.T_a_b = extrinsic_from_planar(T_p, G_a, G_b);
  return answer;
}

}  // namespace

Answer detail::solve_and_verify(const Problem& problem, const Matrix8d& Q, Method method,
                                const std::optional<DualQuaternion>& start, NanosecondClock clock) {
  const Stopwatch time{clock};
  return problem.mode == Mode::planar ? solve_in_plane(problem, Q, method, start, time)
                                      : solve_spatial(problem, Q, method, start, time);
}

namespace {

/// The cost that is held at the prior in hidden directions. Empty: the motions show every direction, or the
/// minimum is at the prior.
std::optional<detail::HeldCost> held(const Problem& problem, const Matrix8d& Q, const Answer& minimum) {
  if (!problem.prior || problem.mode == Mode::planar || minimum.status != SolverStatus::converged)
    return std::nullopt;
  const DirectionBasis hidden = hidden_directions(problem, Q, minimum.T_a_b);
  if (hidden.basis.cols() == 0) return std::nullopt;
  return detail::held_at_prior(Q, minimum.T_a_b, *problem.prior, hidden);
}

}  // namespace

Matrix8d certified_cost(const Problem& problem) {
  Matrix8d Q = cost_matrix(problem);
  if (!problem.prior || problem.mode == Mode::planar) return Q;
  const std::optional<detail::HeldCost> cost =
      held(problem, Q, detail::solve_and_verify(problem, Q, Method::dual));
  return cost ? cost->Q : Q;
}

Answer solve(const Problem& problem, Method method, const std::optional<DualQuaternion>& start,
             NanosecondClock clock) {
  const Matrix8d Q = cost_matrix(problem);
  Answer minimum = detail::solve_and_verify(problem, Q, method, start, clock);
  minimum.observability = assess_observability(problem, Q, minimum.T_a_b);
  minimum.minimum = minimum.T_a_b;
  const std::optional<detail::HeldCost> cost = held(problem, Q, minimum);
  if (!cost) return minimum;
  Answer answer = detail::solve_and_verify(problem, cost->Q, method, cost->start, clock);
  answer.solve_ns += minimum.solve_ns;
  answer.verify_ns += minimum.verify_ns;
  answer.observability = minimum.observability;
  answer.minimum = minimum.T_a_b;
  return answer;
}

}  // namespace egocal
