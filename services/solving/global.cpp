// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "solving/global.hpp"

#include <utility>

namespace egocal::services {

GlobalSolver::GlobalSolver(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig, Method method,
                           bool always)
    : Solver(loop, heartbeat, rig),
      method_(method),
      always_(always),
      scales_(loop, heartbeat, rig),
      tasks_(rig.pairs.size()) {
  report();
}

std::string GlobalSolver::advice() const {
  return heartbeat_.alive(bus::Role::fast) ? "" : "no fast solver is alive: every problem is solved globally";
}

void GlobalSolver::answer_newest() {
  scales_.answer_newest();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Task& task = tasks_[i];
    if (std::optional<ReceivedProblem> received = take(i)) task.unanswered = std::move(received);
    if (!task.unanswered || pairs_[i]->paused || !(steps_in() || task.asked)) continue;
    const ReceivedProblem received = *std::exchange(task.unanswered, std::nullopt);
    AnswerOutbox& outbox = pairs_[i]->outbox;
    if (!outbox.repeat(received.message))
      outbox.send(
          scales_.with_spread(solve(received.problem, method_, std::nullopt, &monotonic_ns), received),
          received.message, false);
  }
}

void GlobalSolver::hear(std::size_t pair, const calibration_t& message) {
  if (message.fallback)
    tasks_[pair].asked = true;
  else if (heartbeat_.role_of(message.solver) == bus::Role::fast)
    tasks_[pair].asked = false;
}

}  // namespace egocal::services
