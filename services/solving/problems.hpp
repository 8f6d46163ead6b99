// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/newest.hpp"
#include "egocal/bus/rig.hpp"

namespace egocal::services {

/// A problem as it came, and its checked mathematics.
struct ReceivedProblem {
  problem_t message{};
  Problem problem;
};

/// Whether there is a last answer, and it is one to this very problem.
template <class Answer, class Problem>
bool answers(const std::optional<Answer>& last, const Problem& problem) {
  return last && last->session == problem.session && last->seq == problem.seq && last->utime == problem.utime;
}

/// A message about this pair, checked and converted; refused if it names another pair.
template <class T, class Message>
bus::Checked<T> of_pair(bus::Checked<T> checked, const Message& message, const std::string& a,
                        const std::string& b) {
  if (checked && (message.sensor_a != a || message.sensor_b != b)) return {{}, "sensors of another pair"};
  return checked;
}

/// The newest problem of one sensor pair.
class ProblemInbox {
 public:
  ProblemInbox(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::PairConfig& pair);

  /// The newest problem since the last call, if one came that passes the checks. Counts the others.
  std::optional<ReceivedProblem> take();
  const std::string& sensor_a() const { return sensor_a_; }
  const std::string& sensor_b() const { return sensor_b_; }
  /// Problems that were skipped because a newer one had arrived.
  std::int64_t skipped() const { return newest_.skipped(); }

 private:
  bus::Heartbeat& heartbeat_;
  std::string sensor_a_, sensor_b_;
  bus::Newest<problem_t> newest_;
};

/// Sends an answer and remembers it. If the problem is sent again, so is the answer, for listeners that came
/// late.
class AnswerOutbox {
 public:
  AnswerOutbox(bus::Loop& loop, bus::Heartbeat& heartbeat) : loop_(loop), heartbeat_(heartbeat) {}

  /// Sends the last answer again if it answers this very problem. False: it does not.
  bool repeat(const problem_t& problem);
  void send(const Answer& answer, const problem_t& problem, bool fallback);

 private:
  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  std::optional<calibration_t> last_;
};

/// Pairing repeats its problems every second. After half a second more without one it counts as silent [us],
/// and solvers repeat their answers themselves.
constexpr std::int64_t pairing_is_silent_us = 1'500'000;

/// CLOCK_MONOTONIC for the library's timings [ns].
std::int64_t monotonic_ns();

}  // namespace egocal::services
