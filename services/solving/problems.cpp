// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "solving/problems.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "egocal/bus/check.hpp"

namespace egocal::services {

ProblemInbox::ProblemInbox(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::PairConfig& pair)
    : heartbeat_(heartbeat),
      sensor_a_(pair.a),
      sensor_b_(pair.b),
      newest_(loop, bus::problem_channel(pair.a, pair.b)) {}

std::optional<ReceivedProblem> ProblemInbox::take() {
  ReceivedProblem received;
  if (!newest_.take(received.message)) return std::nullopt;
  ++heartbeat_.counter("in");
  bus::Checked<Problem> problem =
      of_pair(bus::to_problem(received.message), received.message, sensor_a_, sensor_b_);
  if (!problem) {
    heartbeat_.reject(problem.reason);
    return std::nullopt;
  }
  received.problem = std::move(*problem.value);
  return received;
}

bool AnswerOutbox::repeat(const problem_t& problem) {
  if (!answers(last_, problem)) return false;
  loop_.publish(bus::calibration_channel(problem.sensor_a, problem.sensor_b), *last_);
  return true;
}

void AnswerOutbox::send(const Answer& answer, const problem_t& problem, bool fallback) {
  EGOCAL_CHECK(
      answer.certificate.optimality != Optimality::certified || std::isfinite(answer.certificate.gap),
      "a certified answer has a finite gap");
  calibration_t message = bus::to_message(answer, problem);
  message.solver = heartbeat_.identity().name;
  message.fallback = fallback;
  message.solve_ns = answer.solve_ns;
  message.verify_ns = answer.verify_ns;
  if (problem.host == loop_.host() && problem.received_mono_us > 0)
    message.latency_us = std::max<std::int64_t>(0, loop_.mono_us() - problem.received_mono_us);
  loop_.publish(bus::calibration_channel(problem.sensor_a, problem.sensor_b), message);
  ++heartbeat_.counter("out");
  message.latency_us = -1;  // of the first time only
  last_ = std::move(message);
}

std::int64_t monotonic_ns() {
  return bus::system_clock().mono_ns();
}

}  // namespace egocal::services
