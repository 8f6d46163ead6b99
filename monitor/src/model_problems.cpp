// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How the model handles problems from pairing: sessions, motions, outliers and clocks.
#include <algorithm>
#include <cmath>

#include "answer_text.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

namespace {

double share_of_outliers(const problem_t& problem) {
  const double matched = std::max(0.0, static_cast<double>(problem.matched)),
               outliers = std::max(0.0, static_cast<double>(problem.left_out));
  return outliers > 0 && matched + outliers >= 20 ? outliers / (matched + outliers) : 0;
}

}  // namespace

void Model::begin_session(PairState& pair, std::int64_t session) {
  if (pair.answer()) {
    pair.previous = *pair.answer();
    // as it was shown: the verdict goes with its session
    for (std::size_t i = 0; i < 6; ++i) {
      pair.previous->observable[i] = pair.shown.observability.observable[i];
      pair.previous->stddev[i] = pair.shown.observability.stddev[i];
    }
  }
  pair.session = session;
  pair.verdict.reset();
  pair.scale.reset();
  pair.solvers.clear();
  pair.behind_in_a_row = 0;
  pair.unanswered.forget();
  pair.old = 0;
  pair.counted = -1;
  pair.shown = {};
  pair.only_fast_since.reset();
  pair.certified = pair.fallback = false;
  pair.time_offset_known = false;
  pair.reported_left_out = 0;
}

/// Pairing continues from an older state, after a power cut or when a backup was restored: what is known of
/// problems that no longer exist says nothing about new ones. One problem may be late, three in a row are
/// not.
void Model::follow_back(PairState& pair, const problem_t& message, Now now) {
  constexpr int confirmations = 3;  // as of tools::Answers: one or two may have been overtaken
  const calibration_t* const answer = pair.answer();
  pair.behind_in_a_row = answer && message.seq < answer->seq ? pair.behind_in_a_row + 1 : 0;
  if (pair.behind_in_a_row < confirmations) return;
  pair.behind_in_a_row = 0;
  note(Severity::warning, pair_name(pair.a, pair.b),
       "the calibration continues from an older state: " + std::to_string(answer->seq - message.seq) +
           " motions are gone",
       now);
  std::erase_if(pair.solvers, [&](const SolverTrack& track) { return track.answer.seq > message.seq; });
  if (pair.verdict && pair.verdict->seq > message.seq) pair.verdict.reset();
  if (pair.scale && pair.scale->seq > message.seq) pair.scale.reset();
  count_answer(pair, now);
}

/// Notes outliers once, and again where their share has doubled.
void Model::note_outliers(PairState& pair, Now now) {
  const double share = share_of_outliers(pair.problem);
  if (share > options_.many_outliers && share > 2 * pair.reported_left_out) {
    pair.reported_left_out = share;
    note(Severity::warning, pair_name(pair.a, pair.b),
         number(100 * share, 0, Charset::ascii) +
             " % of the motions contradict the others and are rejected as outliers",
         now);
  } else if (share < 0.5 * options_.many_outliers) {
    pair.reported_left_out = 0;
  }
}

/// Notes the time offset if it has changed by a millisecond and by three of its standard deviations.
void Model::note_time_offset(PairState& pair, Now now) {
  const double offset = pair.problem.time_offset;  // [s]
  if (!std::isfinite(offset)) return;
  if (!pair.time_offset_known) {
    pair.reported_time_offset = offset;
    pair.time_offset_known = true;
    return;
  }
  const double spread = pair.problem.time_offset_stddev >= 0 ? 3 * pair.problem.time_offset_stddev : 0;
  if (!(std::abs(offset - pair.reported_time_offset) > std::max(1e-3, spread))) return;
  note(Severity::info, pair_name(pair.a, pair.b),
       "time offset changed from " + number(pair.reported_time_offset * 1e3, 1, Charset::ascii) + " to " +
           number(offset * 1e3, 1, Charset::ascii) + " ms",
       now);
  pair.reported_time_offset = offset;
}

void Model::on_problem(const problem_t& message, Now now) {
  now_ = now;
  ++messages_;
  PairState* pair = find_pair(bounded(message.sensor_a), bounded(message.sensor_b));
  if (!pair) return;
  const std::string name = pair_name(pair->a, pair->b);
  if (pair->session != message.session) {
    if (pair->has_problem) note_new_session(*pair, message.session, now);
    begin_session(*pair, message.session);
  } else if (pair->has_problem) {
    watch_time(*pair, message, now);
    follow_back(*pair, message, now);
  }
  if (pair->paused && message.seq > pair->problem.seq && message.session == pair->problem.session &&
      seconds_between(pair->paused_mono_us, now.mono_us) > options_.settle)
    pair->paused = false;  // it was resumed, or the command was lost
  if (pair->silent) note(Severity::good, name, "the stream is back", now);
  if (!pair->has_problem || pair->problem.session != message.session || message.seq > pair->problem.seq) {
    if (pair->standing_reported) note(Severity::good, name, "new motions come again", now);
    pair->standing_reported = false;
    pair->standing = 0;
    pair->motion_mono_us = now.mono_us;
  }
  const bool sum = sums_strides(message);
  const bool chosen_anew = pair->has_problem && (sums_strides(pair->problem) != sum ||
                                                 (!sum && pair->problem.stride != message.stride));
  pair->silent = pair->no_network = false;
  pair->has_problem = true;
  pair->problem_at = now;

  problem_t& kept = pair->problem;
  kept = message;
  kept.sensor_a = pair->a;
  kept.sensor_b = pair->b;
  kept.choice = bounded(message.choice);
  kept.host = bounded(message.host);
  if (pair->verdict && message.seq > pair->verdict->seq && !pair->verdict->behind_mono_us)
    pair->verdict->behind_mono_us = now.mono_us;
  note_unanswered(*pair, now);
  kept.n_blocks = 0;
  kept.blocks = {};  // verified by now, and too large to keep with every copy of the model
  if (chosen_anew)
    note(Severity::info, name,
         sum ? "the motions are now a " + kept.choice
             : "stride is now " + std::to_string(kept.stride) + " (" + kept.choice + ")",
         now);
  note_outliers(*pair, now);
  note_time_offset(*pair, now);
}

}  // namespace egocal::monitor
