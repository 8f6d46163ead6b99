// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "answer_text.hpp"
#include "egocal/bus/answer_check.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/loops.hpp"
#include "egocal/online/algorithm1.hpp"

namespace egocal::monitor {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::string rounded(double value, int decimals) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  return buffer;
}

double share_of_outliers(const problem_t& problem) {
  const double matched = std::max(0.0, static_cast<double>(problem.matched)),
               outliers = std::max(0.0, static_cast<double>(problem.left_out));
  return outliers > 0 && matched + outliers >= 20 ? outliers / (matched + outliers) : 0;
}

Optimality optimality_of(const calibration_t& answer) {
  return bus::optimality_from_wire(answer.status).value_or(Optimality::undecided);
}

bus::StandingRank rank_of(const SolverTrack& track) {
  const calibration_t& answer = track.answer;
  return {track.verified ? bus::Standing::verified : bus::Standing::unverified,
          {answer.session, answer.seq, optimality_of(answer), answer.cost}};
}

}  // namespace

bool pair_is_paused(const Model& model, const PairState& pair) {
  return pair.paused || std::any_of(model.processes().begin(), model.processes().end(), [](const auto& p) {
           return p.alive && p.status.role == bus::role_name(Role::pairing) && p.state == bus::State::paused;
         });
}

bool pairing_is_silent(const PairState& pair) {
  return pair.answer() && (!pair.has_problem || pair.silent);
}

std::string pair_name(const std::string& a, const std::string& b) {
  return a + " -> " + b;
}

std::optional<Pose> pose_from(const double pos[3], const double quat_wxyz[4]) {
  Pose pose;
  pose.translation = Eigen::Vector3d(pos[0], pos[1], pos[2]);
  pose.rotation = Eigen::Quaterniond(quat_wxyz[0], quat_wxyz[1], quat_wxyz[2], quat_wxyz[3]);
  const double norm = pose.rotation.norm();
  if (!pose.translation.allFinite() || !(norm > 1e-3 && norm < 1e3)) return std::nullopt;
  pose.rotation.coeffs() /= norm;
  return pose;
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
    // what was good and is bad now, or the other way round, is listed in its order
    if (severity == Severity::good || severity == Severity::bad) break;
  }
  ++events_seen_;
  if (events_.size() == max_events) events_.pop_front();
  events_.push_back({now, severity, subject, text, 1});
}

void Model::begin_session(PairState& pair, std::int64_t session) {
  if (pair.answer()) pair.previous = *pair.answer();
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

/// Pairing continues from an older state (a power cut, an old state that was put back): what was received
/// about problems that are no longer there says nothing of those to come. One problem may be late, three in a
/// row are not.
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

  const double share = share_of_outliers(kept);
  if (share > options_.many_outliers && share > 2 * pair->reported_left_out) {
    pair->reported_left_out = share;
    note(Severity::warning, name,
         rounded(100 * share, 0) + " % of the motions contradict the others and are rejected as outliers",
         now);
  } else if (share < 0.5 * options_.many_outliers) {
    pair->reported_left_out = 0;
  }

  if (std::isfinite(kept.time_offset)) {
    const double spread = kept.time_offset_stddev >= 0 ? 3 * kept.time_offset_stddev : 0;
    if (!pair->time_offset_known) {
      pair->reported_time_offset = kept.time_offset;
      pair->time_offset_known = true;
    } else if (std::abs(kept.time_offset - pair->reported_time_offset) > std::max(1e-3, spread)) {
      note(Severity::info, name,
           "time offset changed from " + rounded(pair->reported_time_offset * 1e3, 1) + " to " +
               rounded(kept.time_offset * 1e3, 1) + " ms",
           now);
      pair->reported_time_offset = kept.time_offset;
    }
  }
}

Role Model::role_of(const calibration_t& message) const {
  for (const ProcessState& process : processes_)
    if (process.status.name == message.solver) {
      const auto role = bus::role_from_name(process.status.role);
      if (role == Role::global || role == Role::fast) return *role;
    }
  if (message.solver.find("global") != std::string::npos) return Role::global;
  if (message.solver.find("fast") != std::string::npos) return Role::fast;
  return message.method == "dual" || message.method == "sdp" ? Role::global : Role::fast;
}

Shown shown_of(const PairState& pair, const calibration_t& answer) {
  Shown shown;
  shown.error_translation = shown.error_rotation = not_a_number;
  std::optional<Pose> reference;
  if (pair.has_problem && pair.problem.has_truth) {
    reference = pose_from(pair.problem.truth_pos, pair.problem.truth_quat);
    if (reference) shown.reference = ReferenceKind::truth;
  }
  if (!reference && pair.has_problem && pair.problem.has_prior) {
    reference = pose_from(pair.problem.prior_pos, pair.problem.prior_quat);
    if (reference) shown.reference = ReferenceKind::nominal;
  }
  const auto T = pose_from(answer.pos, answer.quat);
  if (!T) return shown;
  shown.valid = true;
  shown.T_a_b = *T;
  if (reference) {
    const ExtrinsicError error = extrinsic_error(to_dual_quaternion(*reference), to_dual_quaternion(*T));
    shown.error_translation = error.translation;
    shown.error_rotation = error.rotation;
  }
  return shown;
}

namespace {

/// The answer with texts of limited length; what is no transform is not certified.
calibration_t bounded_answer(const calibration_t& message, const PairState& pair) {
  calibration_t answer = message;
  answer.sensor_a = pair.a;
  answer.sensor_b = pair.b;
  answer.solver = bounded(message.solver);
  answer.method = bounded(message.method);
  answer.hint = bounded(message.hint);
  if (message.status == 0 && (!pose_from(message.pos, message.quat) || std::isnan(message.scaled_gap)))
    answer.status = bus::wire_status(Optimality::undecided);
  return answer;
}

std::array<double, curve_count> curve_values(const Shown& own, const calibration_t& message, Role role) {
  std::array<double, curve_count> values{};
  values[rotation_error] = own.error_rotation;
  values[translation_error] = own.error_translation;
  if (own.reference == ReferenceKind::none) {
    values[translation_error] = std::max({message.stddev[0], message.stddev[1], message.stddev[2]});
    values[rotation_error] = std::max({message.stddev[3], message.stddev[4], message.stddev[5]});
  }
  // where the fast process solved globally itself, its own solution is not known
  const bool own_solution = role != Role::fast || (message.method != "dual" && message.method != "sdp");
  values[scaled_gap] = own_solution ? message.scaled_gap : not_a_number;
  values[execution_time] =
      (static_cast<double>(message.solve_ns) + static_cast<double>(message.verify_ns)) * 1e-9;
  return values;
}

}  // namespace

void Model::count_answer(PairState& pair, Now now) {
  int best = -1;
  for (std::size_t i = 0; i < pair.solvers.size(); ++i)
    if (best < 0 || outranks(rank_of(pair.solvers[i]), rank_of(pair.solvers[static_cast<std::size_t>(best)])))
      best = static_cast<int>(i);
  pair.counted = best;
  pair.shown = best >= 0 ? shown_of(pair, *pair.answer()) : Shown{};
  note_unanswered(pair, now);
  watch_certificate(pair, now);
}

void Model::watch_certificate(PairState& pair, Now now) {
  const calibration_t* answer = pair.answer();
  if (!answer) return;
  const std::string name = pair_name(pair.a, pair.b);
  if (answer->status == 0) {
    if (!pair.certified) note(Severity::good, name, "optimal (proven), by " + answer->solver, now);
    pair.certified = true;
    pair.certified_mono_us = now.mono_us;
  } else if (pair.certified && seconds_between(pair.certified_mono_us, now.mono_us) > options_.settle) {
    pair.certified = false;
    note(Severity::bad, name,
         answer->status == 1 ? "proof lost: a better answer is known" : "proof lost: too imprecise to decide",
         now);
  }
}

void Model::on_calibration(const calibration_t& message, Now now, bool verified) {
  now_ = now;
  ++messages_;
  PairState* pair = find_pair(bounded(message.sensor_a), bounded(message.sensor_b));
  if (!pair) return;
  if (pair->has_problem ? message.session != pair->session : message.session < pair->session) return;
  if (!pair->has_problem && message.session != pair->session) begin_session(*pair, message.session);
  const std::string name = pair_name(pair->a, pair->b);

  const std::string solver = bounded(message.solver);
  SolverTrack* track = nullptr;
  for (SolverTrack& candidate : pair->solvers)
    if (candidate.name == solver) track = &candidate;
  if (!track) {
    if (pair->solvers.size() == max_solvers) {
      // a long session of swapped solvers: the one that has been silent the longest makes room
      auto oldest =
          std::min_element(pair->solvers.begin(), pair->solvers.end(),
                           [](const auto& x, const auto& y) { return x.at.mono_us < y.at.mono_us; });
      pair->solvers.erase(oldest);
    }
    track = &pair->solvers.emplace_back();
    track->name = solver;
    if (pair->solvers.size() > 1 || pair->counted >= 0)
      note(Severity::info, name,
           "solver added: " + solver + " (" + bounded(message.method) + ") answers as well", now);
  } else if (track->answer.method != bounded(message.method)) {
    // a fast solver's first answers are of another method: until it knows of the global solver, or is near
    if (track->settled || track->role != Role::fast)
      note(Severity::info, name,
           "solver swapped: " + solver + " changed from " + track->answer.method + " to " +
               bounded(message.method),
           now);
  } else if (track->silent) {
    note(Severity::good, name, solver + " answers again", now);
  }
  const bool newer = track->answers == 0 || (verified && !track->verified) ||
                     (verified == track->verified && message.seq >= track->answer.seq);
  track->silent = false;
  track->at = now;
  ++track->answers;
  if (!newer) return;  // overtaken on the way

  track->answer = bounded_answer(message, *pair);
  track->verified = verified;
  track->role = role_of(track->answer);

  const double time = seconds_between(pair->session, message.utime);
  if (track->role == Role::global || message.fallback) {
    pair->only_fast_since.reset();
  } else if (!pair->only_fast_since && track->answer.status == 0) {
    pair->only_fast_since = time;
  }
  watch_fallback(*pair, *track, message, now);

  // every solver's own course, so that two can be compared
  if (time >= 0 && time < options_.longest_session)
    track->history.add(time, curve_values(shown_of(*pair, message), message, track->role));
  count_answer(*pair, now);
}

/// A fast solver that starts has no answer to start from, and asks for one: no fallback.
void Model::watch_fallback(PairState& pair, SolverTrack& track, const calibration_t& message, Now now) {
  const std::string name = pair_name(pair.a, pair.b);
  if (track.role == Role::fast) {
    const bool alone =
        !message.fallback && track.answer.status == 0 && message.method != "dual" && message.method != "sdp";
    if (!alone)
      track.alone_mono_us.reset();
    else if (!track.alone_mono_us)
      track.alone_mono_us = now.mono_us;
  }
  if (message.fallback) {
    if (!pair.fallback && track.settled)
      note(Severity::warning, name, "fallback: " + track.name + " asked for the global solver", now);
    else if (!pair.fallback)
      note(Severity::info, name, track.name + " starts from answers of the global solver", now);
    if (!pair.fallback) pair.fallback_at_start = !track.settled;
    pair.fallback = true;
    pair.fallback_mono_us = now.mono_us;
  } else if (pair.fallback && seconds_between(pair.fallback_mono_us, now.mono_us) > options_.settle) {
    pair.fallback = false;
    note(Severity::good, name,
         pair.fallback_at_start ? "only the fast solver runs" : "only the fast solver runs again", now);
  }
  if (track.alone_mono_us && seconds_between(*track.alone_mono_us, now.mono_us) > options_.settle)
    track.settled = true;
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
  for (PairState& pair : pairs_) {
    const std::int64_t heard = std::max(pair.problem_at.mono_us, network_mono_us_);
    const bool silent = seconds_between(heard, now.mono_us) > options_.stream_timeout;
    if (network_away_)
      pair.no_network = pair.has_problem;
    else if (silent)
      pair.no_network = false;
    if (pair.has_problem && !pair.silent && !pair.no_network && silent) {
      pair.silent = true;
      note(Severity::info, pair_name(pair.a, pair.b),
           "the stream is silent: no new motion for " + rounded(options_.stream_timeout, 0) + " s", now);
    }
    watch_age_of_verdict(pair, now);
    watch_age_of_answer(pair, now);
    watch_motions(pair, now);
    watch_solvers(pair, now);
  }
}

/// A solver is missed only where there is something to solve, and only after it has had time to.
void Model::watch_solvers(PairState& pair, Now now) {
  if (!pair.has_problem || pair.silent || pair.no_network || pair_is_paused(*this, pair))
    pair.idle_mono_us = now.mono_us;
  for (SolverTrack& track : pair.solvers) {
    const double unanswered = seconds_between(std::max(track.at.mono_us, pair.idle_mono_us), now.mono_us);
    if (track.role != Role::fast || track.silent || unanswered <= options_.stream_timeout) continue;
    track.silent = true;
    note(Severity::bad, pair_name(pair.a, pair.b), "solver swapped: " + track.name + " no longer answers",
         now);
  }
}

}  // namespace egocal::monitor
