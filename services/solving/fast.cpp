// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "solving/fast.hpp"

#include <algorithm>

#include "program/commands.hpp"

namespace egocal::services {

FastSolver::FastSolver(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig, Method method)
    : loop_(loop), heartbeat_(heartbeat) {
  options_.fast = method;
  options_.t_no_fail = rig.t_no_fail;
  options_.clock = &monotonic_ns;
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
  loop_.every(std::chrono::seconds(1), [this] { report(); });
  report();
}

void FastSolver::obey(Verb verb, const command_t& command) {
  bool any = false;
  for (const auto& pair : pairs_) {
    if (!means(command, verb, pair->inbox.sensor_a(), pair->inbox.sensor_b(), pair->session)) continue;
    any = true;
    if (verb == Verb::reset)
      pair->state = {};
    else
      pair->paused = verb == Verb::pause;
  }
  if (!any) heartbeat_.reject(not_meant);
  report();
}

void FastSolver::report() {
  const bool fallback_missing = !heartbeat_.alive("global");
  const bool paused =
      std::all_of(pairs_.begin(), pairs_.end(), [](const auto& pair) { return pair->paused; });
  heartbeat_.set_state(paused ? "paused" : "running");
  if (const auto elder = heartbeat_.elder_namesake())
    heartbeat_.set_error("a second process has this name: pid " + std::to_string(elder->pid) + " on " +
                         elder->host);
  else
    heartbeat_.set_error(fallback_missing ? "no global solver is heard: its work is done here" : "");
}

void FastSolver::answer_newest() {
  for (const auto& pair : pairs_)
    if (const std::optional<ReceivedProblem> received = pair->inbox.take()) answer(*pair, *received);
}

void FastSolver::answer(Pair& pair, const ReceivedProblem& received) {
  const problem_t& message = received.message;
  if (pair.paused || pair.outbox.repeat(message)) return;
  if (message.session != pair.session || message.utime < pair.utime) pair.state = {};
  pair.session = message.session;
  pair.utime = message.utime;
  pair.seq = message.seq;
  OnlineOptions options = options_;
  if (heartbeat_.alive("global")) options.global.reset();
  const OnlineStep step = algorithm1_step(received.problem, message.utime, pair.state, options);
  pair.state = step.state;
  const bool asks = step.global_wanted && !step.global_used;
  pair.outbox.send(step.answer, message, asks);
  ++heartbeat_.counter(step.fast_verified ? "verified" : "not verified");
  if (asks) ++heartbeat_.counter("asked for the global solver");
  if (step.global_used) ++heartbeat_.counter("solved globally here");
}

void FastSolver::hear(Pair& pair, const calibration_t& message) {
  if (message.solver == heartbeat_.identity().name || pair.session < 0) return;
  if (message.session != pair.session) {
    heartbeat_.reject("answer of another session");
    return;
  }
  // the global answer that was asked for is where the next step starts
  if (message.status != 0 || message.utime < pair.utime) return;
  const bus::Checked<Answer> answer = bus::to_answer(message);
  if (!answer)
    heartbeat_.reject(answer.reason);
  else
    pair.state.last = answer.value->T_a_b;
}

}  // namespace egocal::services
