// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "egocal/certificate/certificate.hpp"
#include "egocal/problem/problem.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/uncertainty/directions.hpp"

namespace egocal {

/// How to solve (18). In planar mode dual and sdp are the closed form; sqp is too (it needs no start).
enum class Method { dual, sdp, sqp, slsqp };
std::string_view to_string(Method method);
std::optional<Method> method_from_name(std::string_view name);  ///< also "global" (dual) and "fast" (sqp)

/// Fit (cost), optimality (certificate) and uncertainty (observability) are three different things.
struct Answer {
  DualQuaternion T_a_b;    ///< pose of sensor b in sensor a, canonical sign
  DualQuaternion minimum;  ///< of the cost of the motions alone; T_a_b but where the prior holds directions
  Certificate certificate;
  Observability observability;
  SolverStatus status = SolverStatus::converged;
  Method method = Method::dual;
  std::int64_t solve_ns = 0;   ///< the solver alone; 0 without a clock [ns]
  std::int64_t verify_ns = 0;  ///< the certificate alone; 0 without a clock [ns]
};
EGOCAL_SAME_LAYOUT(Answer)

/// The caller's clock [ns]: the library has none of its own.
using NanosecondClock = std::int64_t (*)();

/// The cost that the certificate of an answer is about. Along directions that the motions do not show, noise
/// has a minimum that means nothing: where the problem has a prior, squares are added to (16) that hold the
/// answer at the prior there. Without a prior, and in planar mode, it is cost_matrix(). Never throws.
/// Deterministic. Thread-safe.
Matrix8d certified_cost(const Problem& problem);

/// Solve, verify, and say what is known. start: T_a_b for the local methods; without it they start at the
/// global minimum. dual and sdp ignore it, and so does sqp in planar mode. In directions that the motions do
/// not show the answer is at the problem's prior. Without a prior it is the minimum, which is noise along
/// these directions, or the one closest to the identity where the cost is flat. The certificate is about
/// certified_cost().
///
/// Never throws. Without motion the status is degenerate, T_a_b is the prior or the identity, and no
/// direction is observable; all extrinsics cost the same then, so the certificate calls each of them
/// certified. Where the statistics hold NaN or infinity the status is not_finite, the certificate is
/// undecided with an infinite cost, no direction is observable, and T_a_b means nothing. Deterministic but
/// for the two times. Thread-safe where the clock is.
Answer solve(const Problem& problem, Method method, const std::optional<DualQuaternion>& start = std::nullopt,
             NanosecondClock clock = nullptr);

}  // namespace egocal
