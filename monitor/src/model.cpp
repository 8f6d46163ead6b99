// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The state of the model, and what happens as time passes.
#include "egocal/monitor/model.hpp"

#include <algorithm>

#include "answer_text.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/loops.hpp"

namespace egocal::monitor {

bool pair_is_paused(const Model& model, const PairState& pair) {
  return pair.paused || std::any_of(model.processes().begin(), model.processes().end(), [](const auto& p) {
           return p.alive && p.status.role == bus::role_name(Role::pairing) && p.state == bus::State::paused;
         });
}

bool pairing_is_silent(const PairState& pair) {
  return pair.answer() && (!pair.has_problem || pair.silent) && !pair.ended;
}

bool session_has_no_motion(const PairState& pair) {
  return pairing_is_silent(pair) && pair.pairing_runs && !pair.why_standing.empty();
}

std::string pair_name(const std::string& a, const std::string& b) {
  return a + " -> " + b;
}

PairState* Model::find_pair(const std::string& a, const std::string& b) {
  for (PairState& pair : pairs_)
    if (pair.a == a && pair.b == b) return &pair;
  if (pairs_.size() == max_pairs) {
    ++ignored_;
    return nullptr;
  }
  PairState& pair = pairs_.emplace_back();
  pair.a = a;
  pair.b = b;
  return &pair;
}

void Model::expect_pair(const std::string& a, const std::string& b) {
  find_pair(bounded(a), bounded(b));
}

void Model::note(Severity severity, const std::string& full_subject, const std::string& full_text, Now now) {
  now_ = now;
  const std::string subject = bounded(full_subject), text = bounded(full_text);
  const std::size_t recent = std::min<std::size_t>(events_.size(), 16);
  for (std::size_t i = 1; i <= recent; ++i) {
    Event& event = events_[events_.size() - i];
    if (event.subject != subject) continue;
    if (event.text == text && seconds_between(event.at.mono_us, now.mono_us) < options_.repeat) {
      ++event.repeated;
      return;
    }
    // a change between good and bad stays in the list of events, in its order
    if (severity == Severity::good || severity == Severity::bad) break;
  }
  ++events_seen_;
  if (events_.size() == max_events) events_.pop_front();
  events_.push_back({now, severity, subject, text, 1});
}

/// A loop that opens, and one that closes again, as events.
void Model::watch_loops(Now now) {
  std::set<std::array<std::string, 3>> open;
  for (const Loop& loop : loops_of(*this))
    if (loop.open()) open.insert(loop.sensors);
  const auto report = [&](const std::array<std::string, 3>& s, Severity severity, const char* text) {
    note(severity, s[0] + ", " + s[1] + ", " + s[2], text, now);
  };
  for (const auto& sensors : open)
    if (!open_loops_.contains(sensors))
      report(sensors, Severity::bad, "their extrinsics contradict each other: the loop does not close");
  for (const auto& sensors : open_loops_)
    if (!open.contains(sensors)) report(sensors, Severity::good, "their extrinsics agree again");
  open_loops_ = std::move(open);
}

void Model::tick(Now now) {
  now_ = now;
  watch_loops(now);
  watch_processes(now);
  watch_interruptions(now);
  const bool ended = pairing_has_ended();
  const bool pairing_runs =
      std::any_of(processes_.begin(), processes_.end(), [](const ProcessState& process) {
        return process.alive && process.status.role == bus::role_name(Role::pairing) &&
               process.state == bus::State::running;
      });
  for (PairState& pair : pairs_) {
    pair.ended = ended;
    pair.pairing_runs = pairing_runs;
    const std::int64_t heard = std::max(pair.problem_at.mono_us, network_mono_us_);
    const bool silent = seconds_between(heard, now.mono_us) > options_.stream_timeout;
    if (network_away_)
      pair.no_network = pair.has_problem;
    else if (silent)
      pair.no_network = false;
    if (pair.has_problem && !pair.silent && !pair.no_network && silent) {
      pair.silent = true;
      note(Severity::info, pair_name(pair.a, pair.b),
           "the stream is silent: no new motion for " + number(options_.stream_timeout, 0, Charset::ascii) +
               " s",
           now);
    }
    watch_age_of_verdict(pair, now);
    watch_age_of_answer(pair, now);
    watch_motions(pair, now);
    watch_solvers(pair, now);
  }
}

}  // namespace egocal::monitor
