// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How long ago the answer that counts was one of the present.
#include <algorithm>

#include "answer_text.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

/// Called wherever a problem or an answer is new.
void Model::note_unanswered(PairState& pair, Now now) {
  const calibration_t* const answer = pair.answer();
  if (answer && pair.has_problem)
    pair.unanswered.note({pair.session, answer->seq}, pair.problem.seq > answer->seq, now.mono_us);
  else
    pair.unanswered.forget();
}

/// Marks an answer as old: solvers that hang leave one behind, and so does a pairing process.
void Model::watch_age_of_answer(PairState& pair, Now now) {
  if (pair.no_network || pair_is_paused(*this, pair)) pair.unanswered.forget();
  const double unanswered = pair.unanswered.old(now.mono_us, options_.answer_age);
  // without any received problem the answer is not verified, which is shown as well
  const double since = seconds_between(pair.problem_at.mono_us, now.mono_us);
  const bool is_silent = pairing_is_silent(pair) || (pair.no_network && since > options_.stream_timeout);
  const double silent = is_silent && pair.answer() && pair.has_problem ? since : 0;
  const bool was_old = pair.old > 0;
  pair.old = std::max(unanswered, silent);
  if (unanswered > 0 && !was_old)
    note(Severity::bad, pair_name(pair.a, pair.b),
         "the answer is old: no solver answers the motions that came since", now);
}

/// Notices that no new motions come: pairing sends its problem every second, with new motions or without.
void Model::watch_motions(PairState& pair, Now now) {
  const double since = seconds_between(std::max(pair.motion_mono_us, pair.idle_mono_us), now.mono_us);
  const bool stands = pair.has_problem && !pair.silent && !pair.no_network && !pair_is_paused(*this, pair) &&
                      since > options_.standing;
  pair.standing = stands ? since : 0;
  if (!stands || pair.standing_reported || pair.why_standing.empty()) return;
  pair.standing_reported = true;
  note(Severity::warning, pair_name(pair.a, pair.b), standing_text(pair), now);
}

bool is_good(const PairState& pair) {
  const bool finds_no_motion = pair.standing > 0 && !pair.why_standing.empty();
  return pair.answer() && !finds_no_motion && pair.answer()->status == 0 && pair.counted_solver()->verified &&
         pair.shown.valid && pair.old == 0 && pair.verdict &&
         pair.verdict->diagnosis.verdict == Verdict::good && pair.verdict->old == 0 && !departure_of(pair);
}

}  // namespace egocal::monitor
