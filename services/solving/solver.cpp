// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "solving/solver.hpp"

#include <algorithm>

#include "egocal/bus/channels.hpp"

namespace egocal::services {

Solver::Solver(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig)
    : loop_(loop), heartbeat_(heartbeat) {
  for (std::size_t i = 0; i < rig.pairs.size(); ++i) {
    const bus::PairConfig& config = rig.pairs[i];
    pairs_.push_back(std::make_unique<Pair>(loop, heartbeat, config));
    loop_.subscribe<calibration_t>(bus::calibration_channel(config.a, config.b),
                                   [this, i](const calibration_t& message, const bus::Arrival&) {
                                     if (message.solver != heartbeat_.identity().name) hear(i, message);
                                   });
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
    answer_newest();
    repeat_answers();
  });
}

std::optional<ReceivedProblem> Solver::take(std::size_t pair) {
  std::optional<ReceivedProblem> received = pairs_[pair]->inbox.take();
  if (!received) return received;
  Pair& of = *pairs_[pair];
  of.session = received->message.session;
  of.newest = received->message;
  of.newest.n_blocks = 0;
  of.newest.blocks.clear();
  of.heard_mono_us = loop_.mono_us();
  return received;
}

/// Pairing sends its problems again every second, which repeats the answers. If pairing hangs or is gone, new
/// listeners would not learn of any answer without this.
void Solver::repeat_answers() {
  for (const auto& pair : pairs_)
    if (pair->session >= 0 && !pair->paused && loop_.mono_us() - pair->heard_mono_us >= pairing_is_silent_us)
      pair->outbox.repeat(pair->newest);
  repeat_scales();
}

void Solver::obey(Verb verb, const command_t& command) {
  if (verb == Verb::reset && command.to != "*" && !bus::knows_verb(heartbeat_.identity().role, "reset"))
    return heartbeat_.reject(not_understood);
  bool any = false;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Pair& pair = *pairs_[i];
    if (!means(command, verb, pair.inbox.sensor_a(), pair.inbox.sensor_b(), pair.session)) continue;
    any = true;
    if (verb == Verb::reset)
      reset(i);
    else
      pair.paused = verb == Verb::pause;
  }
  if (!any) heartbeat_.reject(not_meant);
  report();
}

void Solver::report() {
  const bool paused =
      std::all_of(pairs_.begin(), pairs_.end(), [](const auto& pair) { return pair->paused; });
  heartbeat_.set_state(paused ? bus::State::paused : state());
  if (const auto other = heartbeat_.senior_namesake())
    heartbeat_.set_error("a second process has this name: pid " + std::to_string(other->pid) + " on " +
                         other->host);
  else
    // right after the start, and after the network was away, no other process has sent its status yet
    heartbeat_.set_error(!paused && heartbeat_.settled() ? advice() : "");
}

}  // namespace egocal::services
