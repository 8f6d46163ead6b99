// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/online/algorithm1.hpp"
#include "egocal/microseconds.hpp"

namespace egocal {

OnlineStep algorithm1_step(const Problem& problem, std::int64_t time_us, const OnlineState& state,
                           const OnlineOptions& options) {
  OnlineStep step;
  step.state = state;
  if (state.last || !options.global) {
    step.answer = solve(problem, options.fast, state.last, options.clock);  // line 6
    step.fast_certificate = step.answer.certificate;                        // line 7
    step.fast_verified = step.answer.certificate.optimality == Optimality::certified;
  }
  if (!state.last || !step.fast_verified) step.state.last_local_error_us = time_us;  // lines 8, 9
  const std::int64_t t_no_fail_us = to_microseconds(options.t_no_fail);
  step.global_wanted =
      step.state.last_local_error_us && time_us - *step.state.last_local_error_us <= t_no_fail_us;
  if (step.global_wanted && options.global) {  // lines 10, 11
    step.answer = solve(problem, *options.global, std::nullopt, options.clock);
    step.global_used = true;
  }
  step.state.last = step.answer.T_a_b;
  return step;
}

bool outranks(const AnswerRank& x, const AnswerRank& y) {
  if (x.session != y.session) return x.session > y.session;
  if (x.seq != y.seq) return x.seq > y.seq;
  const bool x_certified = x.optimality == Optimality::certified;
  const bool y_certified = y.optimality == Optimality::certified;
  if (x_certified != y_certified) return x_certified;
  return x.cost < y.cost;
}

}  // namespace egocal
