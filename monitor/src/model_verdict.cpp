// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the model makes of verdicts.
#include <algorithm>

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
  const PairVerdict verdict{received.diagnosis, received.judged, message.sender, message.seq, now};
  watch_verdict(*pair, verdict, now);
  pair->verdict = verdict;
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

}  // namespace egocal::monitor
