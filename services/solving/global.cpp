// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "solving/global.hpp"

#include <algorithm>

#include "program/commands.hpp"

namespace egocal::services {

GlobalSolver::GlobalSolver(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig, Method method,
                           bool always)
    : loop_(loop), heartbeat_(heartbeat), method_(method), always_(always) {
  for (const bus::PairConfig& config : rig.pairs) {
    pairs_.push_back(std::make_unique<Pair>(loop, heartbeat, config));
    Pair* pair = pairs_.back().get();
    loop_.subscribe<calibration_t>(
        bus::calibration_channel(config.a, config.b),
        [this, pair](const calibration_t& message, const bus::Arrival&) { hear(*pair, message); });
  }
  hear_commands(loop_, heartbeat_, [this](Verb verb, const command_t& command) { obey(verb, command); });
  heartbeat_.before_publish([this] {
    std::int64_t skipped = 0;
    for (const auto& pair : pairs_) skipped += pair->inbox.skipped();
    heartbeat_.counter("skipped") = skipped;
  });
  loop_.after_batch([this](bool) { answer_newest(); });
  loop_.every(std::chrono::seconds(1), [this] {
    report();
    answer_newest();  // what the fast process left unanswered when it fell silent
  });
  report();
}

void GlobalSolver::obey(Verb verb, const command_t& command) {
  bool any = false;
  for (const auto& pair : pairs_) {
    if (!means(command, verb, pair->inbox.sensor_a(), pair->inbox.sensor_b(), pair->session)) continue;
    any = true;
    // nothing to reset: nothing is remembered from problem to problem
    if (verb != Verb::reset) pair->paused = verb == Verb::pause;
  }
  if (!any) heartbeat_.reject(not_meant);
  report();
}

void GlobalSolver::report() {
  const bool paused =
      std::all_of(pairs_.begin(), pairs_.end(), [](const auto& pair) { return pair->paused; });
  heartbeat_.set_state(paused ? "paused" : always_ || !heartbeat_.alive("fast") ? "running" : "waiting");
  if (const auto elder = heartbeat_.elder_namesake())
    heartbeat_.set_error("a second process has this name: pid " + std::to_string(elder->pid) + " on " +
                         elder->host);
  else
    heartbeat_.set_error(
        heartbeat_.alive("fast") ? "" : "no fast solver is heard: every problem is solved globally");
}

void GlobalSolver::answer_newest() {
  const bool steps_in = always_ || !heartbeat_.alive("fast");
  for (const auto& pair : pairs_) {
    if (std::optional<ReceivedProblem> received = pair->inbox.take()) pair->unanswered = std::move(received);
    if (!pair->unanswered || pair->paused || !(steps_in || pair->asked)) continue;
    const ReceivedProblem received = *std::exchange(pair->unanswered, std::nullopt);
    pair->session = received.message.session;
    if (!pair->outbox.repeat(received.message))
      pair->outbox.send(solve(received.problem, method_, std::nullopt, &monotonic_ns), received.message,
                        false);
  }
}

void GlobalSolver::hear(Pair& pair, const calibration_t& message) {
  if (message.solver == heartbeat_.identity().name) return;
  if (message.fallback)
    pair.asked = true;
  else if (heartbeat_.role_of(message.solver) == "fast")
    pair.asked = false;
}

}  // namespace egocal::services
