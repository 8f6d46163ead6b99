// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "solving/fast.hpp"

namespace egocal::services {

FastSolver::FastSolver(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig, Method method)
    : Solver(loop, heartbeat, rig), scales_(loop, heartbeat, rig), progress_(rig.pairs.size()) {
  options_.fast = method;
  options_.t_no_fail = rig.t_no_fail;
  options_.clock = &monotonic_ns;
  report();
}

std::string FastSolver::advice() const {
  return heartbeat_.alive(bus::Role::global)
             ? ""
             : "no global solver is alive: global solutions are computed here as well";
}

void FastSolver::answer_newest() {
  scales_.answer_newest(!heartbeat_.alive(bus::Role::global));
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (const std::optional<ReceivedProblem> received = take(i)) answer(i, *received);
}

void FastSolver::answer(std::size_t pair, const ReceivedProblem& received) {
  const problem_t& message = received.message;
  AnswerOutbox& outbox = pairs_[pair]->outbox;
  if (pairs_[pair]->paused || outbox.repeat(message)) return;
  Progress& progress = progress_[pair];
  if (message.session != progress.session || message.utime < progress.utime) progress.state = {};
  progress.session = message.session;
  progress.utime = message.utime;
  OnlineOptions options = options_;
  if (heartbeat_.alive(bus::Role::global)) options.global.reset();
  const OnlineStep step = algorithm1_step(received.problem, message.utime, progress.state, options);
  progress.state = step.state;
  const bool asks = step.global_wanted && !step.global_used;
  outbox.send(scales_.with_spread(step.answer, received), message, asks);
  ++heartbeat_.counter(step.fast_verified ? "verified" : "not verified");
  if (asks) ++heartbeat_.counter("asked for the global solver");
  if (step.global_used) ++heartbeat_.counter("solved globally here");
}

void FastSolver::hear(std::size_t pair, const calibration_t& message) {
  Progress& progress = progress_[pair];
  if (progress.session < 0) return;
  if (message.session != progress.session) {
    heartbeat_.reject("answer of another session");
    return;
  }
  const bus::Checked<Answer> answer = bus::to_answer(message);
  if (!answer) {
    heartbeat_.reject(answer.reason);
    return;
  }
  // The next step starts from the global answer that was asked for. That needs no proof here, because the
  // step itself is verified.
  if (answer.value->certificate.optimality == Optimality::certified && message.utime >= progress.utime)
    progress.state.last = answer.value->T_a_b;
}

}  // namespace egocal::services
