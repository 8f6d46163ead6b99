// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "solving/scales.hpp"

#include <utility>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/scale.hpp"

namespace egocal::services {

ScaleDesk::Pair::Pair(bus::Loop& loop, const bus::PairConfig& pair)
    : config(pair), inbox(loop, bus::scale_problem_channel(pair.a, pair.b)) {}

ScaleDesk::ScaleDesk(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig)
    : loop_(loop), heartbeat_(heartbeat) {
  for (const bus::PairConfig& pair : rig.pairs)
    if (bus::unscaled_side(rig, pair)) pairs_.push_back(std::make_unique<Pair>(loop, pair));
}

void ScaleDesk::answer_newest(bool publishes) {
  for (const auto& pair : pairs_) {
    scale_problem_t problem{};
    if (!pair->inbox.take(problem)) continue;
    pair->heard_mono_us = loop_.mono_us();
    answer(*pair, problem, publishes);
  }
}

void ScaleDesk::repeat(bool publishes) {
  for (const auto& pair : pairs_)
    if (publishes && pair->last && loop_.mono_us() - pair->heard_mono_us >= pairing_is_silent_us)
      loop_.publish(bus::scale_channel(pair->config.a, pair->config.b), *pair->last);
}

Answer ScaleDesk::with_spread(Answer answer, const ReceivedProblem& received) const {
  for (const auto& pair : pairs_)
    if (pair->config.a == received.message.sensor_a && pair->config.b == received.message.sensor_b &&
        pair->last && pair->last->session == received.message.session)
      answer.observability =
          with_spread_of_scale(std::move(answer.observability), received.problem, pair->solution);
  return answer;
}

void ScaleDesk::answer(Pair& pair, const scale_problem_t& problem, bool publishes) {
  const std::string channel = bus::scale_channel(pair.config.a, pair.config.b);
  if (answers(pair.last, problem)) {
    if (publishes) loop_.publish(channel, *pair.last);
    return;
  }
  const bus::Checked<ScaleProblem> checked =
      of_pair(bus::to_scale_problem(problem), problem, pair.config.a, pair.config.b);
  if (!checked) return heartbeat_.reject(checked.reason);
  const std::int64_t begin = monotonic_ns();
  pair.solution = solve_scale(checked.value->blocks, checked.value->options);
  scale_t message = bus::to_message(pair.solution, problem);
  message.solver = heartbeat_.identity().name;
  message.solve_ns = monotonic_ns() - begin;
  if (publishes) {
    loop_.publish(channel, message);
    ++heartbeat_.counter("scales");
  }
  pair.last = std::move(message);
}

}  // namespace egocal::services
