// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the model makes of verdicts.
#include <algorithm>

#include "egocal/microseconds.hpp"

#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

namespace {

Severity severity_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::good:
      return Severity::good;
    case Verdict::incomplete:
      return Severity::info;
    case Verdict::doubtful:
      return Severity::warning;
    case Verdict::contradictory:
      break;
  }
  return Severity::bad;
}

bool names(const Diagnosis& diagnosis, const Finding& wanted) {
  return std::any_of(diagnosis.findings.begin(), diagnosis.findings.end(),
                     [&](const Finding& finding) { return finding.certain && finding.code == wanted.code; });
}

}  // namespace

void Model::on_verdict(const verdict_t& message, const bus::ReceivedVerdict& received, Now now) {
  now_ = now;
  ++messages_;
  PairState* pair = find_pair(message.sensor_a, message.sensor_b);
  if (!pair || (pair->has_problem && message.session != pair->session)) return;
  if (!pair->has_problem && message.session != pair->session) {
    if (message.session < pair->session) return;
    begin_session(*pair, message.session);
  }
  if (pair->verdict && message.seq < pair->verdict->seq) return;  // overtaken on the way
  PairVerdict verdict{received.diagnosis, received.judged, message.sender, message.seq, now};
  if (pair->verdict && message.seq == pair->verdict->seq) {
    verdict.behind_mono_us = pair->verdict->behind_mono_us;
    verdict.old = pair->verdict->old;
  } else if (pair->has_problem && pair->problem.seq > message.seq) {
    verdict.behind_mono_us = now.mono_us;
  }
  std::string& reason = verdict.diagnosis.reason;
  reason.erase(reason.find_last_not_of(' ') + 1);  // a sentence that is empty comes behind a blank
  watch_verdict(*pair, verdict, now);
  pair->verdict = verdict;
  if (const calibration_t* answer = pair->answer()) pair->shown = shown_of(*pair, *answer);
}

/// What is new in a verdict, as events.
void Model::watch_verdict(const PairState& pair, const PairVerdict& verdict, Now now) {
  const std::string name = pair_name(pair.a, pair.b);
  const Diagnosis& diagnosis = verdict.diagnosis;
  const Diagnosis before = pair.verdict ? pair.verdict->diagnosis : Diagnosis{};
  if (!pair.verdict || before.verdict != diagnosis.verdict)
    note(severity_of(diagnosis.verdict), name,
         "verdict: " + std::string(to_string(diagnosis.verdict)) + ". " + diagnosis.reason, now);
  for (const Finding& finding : diagnosis.findings)
    if (finding.certain && !names(before, finding) && finding.message != diagnosis.reason)
      note(Severity::warning, name, finding.message, now);
  const bool reached_before = before.goal && before.goal->reached;
  if (diagnosis.goal && diagnosis.goal->reached && !reached_before)
    note(Severity::good, name, "the goal is reached", now);
}

std::optional<bus::Departure> departure_of(const PairState& pair) {
  if (!pair.verdict || !pair.shown.valid) return std::nullopt;
  return bus::departure(pair.verdict->diagnosis.verdict, pair.verdict->judged, pair.shown.T_a_b);
}

/// Marks a verdict as old: a diagnosis that hangs leaves one behind, and the mount may move after it.
void Model::watch_age_of_verdict(PairState& pair, Now now) {
  if (!pair.verdict || !pair.verdict->behind_mono_us) return;
  const auto is_pairing = [](const ProcessState& process) {
    return process.status.role == bus::role_name(Role::pairing);
  };
  const bool over = std::any_of(processes_.begin(), processes_.end(), is_pairing) &&
                    std::all_of(processes_.begin(), processes_.end(), [&](const ProcessState& process) {
                      return !is_pairing(process) || process.state == bus::State::ended;
                    });
  if (pair.no_network || over || pair_is_paused(*this, pair)) {  // nobody is to judge, or nothing of it comes
    pair.verdict->behind_mono_us = now.mono_us;
    pair.verdict->old = 0;
    return;
  }
  const bool gone = std::any_of(processes_.begin(), processes_.end(), [&](const ProcessState& process) {
    return process.status.name == pair.verdict->sender && !process.alive;
  });
  const double within =
      gone ? 0
           : options_.judged_within + options_.judged_within_per_pair * static_cast<double>(pairs_.size());
  const double behind = to_seconds(now.mono_us - *pair.verdict->behind_mono_us);
  if (behind < within) return;
  if (pair.verdict->old == 0)
    note(Severity::warning, pair_name(pair.a, pair.b),
         "the verdict is old, new motions are not judged: is egocal-diagnosis running?", now);
  pair.verdict->old = behind;
}

}  // namespace egocal::monitor
