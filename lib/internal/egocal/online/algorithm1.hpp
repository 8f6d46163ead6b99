// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "egocal/online/answer.hpp"

namespace egocal {

struct OnlineOptions {
  Method fast = Method::sqp;
  /// Method of the global solution. Empty: that is another process's work, and the step only says that it is
  /// wanted.
  std::optional<Method> global = Method::dual;
  double t_no_fail = 5.0;  ///< [s] of measured time that the fast solution must have been verified for
  NanosecondClock clock = nullptr;  ///< for the timings of the answer
};
EGOCAL_SAME_LAYOUT(OnlineOptions)

/// What Algorithm 1 carries from step to step. A default-constructed one is the start: the first step is
/// global.
struct OnlineState {
  std::optional<DualQuaternion> last;               ///< q_(i-1)
  std::optional<std::int64_t> last_local_error_us;  ///< t_lastLocalError
};
EGOCAL_SAME_LAYOUT(OnlineState)

struct OnlineStep {
  Answer answer;
  OnlineState state;  ///< for the next step
  bool fast_verified = false;
  /// Certificate of the fast solution itself, also where the answer is the global one; empty on a first,
  /// global step.
  std::optional<Certificate> fast_certificate;
  bool global_wanted = false;  ///< the fast solution has not been verified for long enough
  bool global_used = false;    ///< the answer is the global solver's
};
EGOCAL_SAME_LAYOUT(OnlineStep)

/// Algorithm 1: fast solution from the last answer, verified; the global one while the fast one has not been
/// verified for t_no_fail. Pure: the same problem, time and state give the same step. time_us: of the
/// problem's newest motion, not of any clock.
OnlineStep algorithm1_step(const Problem& problem, std::int64_t time_us, const OnlineState& state,
                           const OnlineOptions& options = {});

/// What is needed to choose between answers for the same pair.
struct AnswerRank {
  std::int64_t session = 0;
  std::int64_t seq = 0;  ///< of the problem
  Optimality optimality = Optimality::undecided;
  double cost = 0;
};
/// Which of two answers counts: newest problem, certified before uncertified, lower cost. False for equal
/// claims.
bool outranks(const AnswerRank& x, const AnswerRank& y);

}  // namespace egocal
