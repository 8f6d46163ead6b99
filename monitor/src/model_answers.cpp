// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How the model handles answers of the solvers: which one counts, its certificate, and who solves.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "answer_text.hpp"
#include "egocal/bus/answer_check.hpp"
#include "egocal/diagnosis/as_judged.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/model.hpp"
#include "egocal/online/algorithm1.hpp"

namespace egocal::monitor {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Optimality optimality_of(const calibration_t& answer) {
  return bus::optimality_from_wire(answer.status).value_or(Optimality::undecided);
}

bus::StandingRank rank_of(const SolverTrack& track) {
  const calibration_t& answer = track.answer;
  return {track.verified ? bus::Standing::verified : bus::Standing::unverified,
          {answer.session, answer.seq, optimality_of(answer), answer.cost}};
}

/// The answer with texts of limited length. An answer that is no transform is not certified.
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
    values[translation_error] = largest_stddev(own, 0);
    values[rotation_error] = largest_stddev(own, 3);
  }
  // if the fast process solved globally itself, its own solution is unknown
  const bool own_solution = role != Role::fast || (message.method != "dual" && message.method != "sdp");
  values[scaled_gap] = own_solution ? message.scaled_gap : not_a_number;
  values[execution_time] =
      (static_cast<double>(message.solve_ns) + static_cast<double>(message.verify_ns)) * 1e-9;
  return values;
}

Observability observability_of(const PairState& pair, const calibration_t& answer) {
  Observability stated;
  for (std::size_t i = 0; i < 6; ++i) {
    stated.observable[i] = answer.observable[i] != 0;
    stated.stddev[i] = answer.stddev[i];
  }
  stated.hint = answer.hint;
  return pair.verdict ? as_judged(std::move(stated), pair.verdict->diagnosis) : stated;
}

}  // namespace

std::optional<Pose> pose_from(const double pos[3], const double quat_wxyz[4]) {
  Pose pose;
  pose.translation = Eigen::Vector3d(pos[0], pos[1], pos[2]);
  pose.rotation = Eigen::Quaterniond(quat_wxyz[0], quat_wxyz[1], quat_wxyz[2], quat_wxyz[3]);
  const double norm = pose.rotation.norm();
  if (!pose.translation.allFinite() || !(norm > 1e-3 && norm < 1e3)) return std::nullopt;
  pose.rotation.coeffs() /= norm;
  return pose;
}

Shown shown_of(const PairState& pair, const calibration_t& answer) {
  Shown shown;
  shown.observability = observability_of(pair, answer);
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

/// The solver that sent an answer. It is an event when it is new, heard again, or uses another method.
SolverTrack& Model::track_of(PairState& pair, const calibration_t& message, Now now) {
  const std::string name = pair_name(pair.a, pair.b), solver = bounded(message.solver),
                    method = bounded(message.method);
  const auto known = std::find_if(pair.solvers.begin(), pair.solvers.end(),
                                  [&](const SolverTrack& track) { return track.name == solver; });
  if (known == pair.solvers.end()) {
    if (pair.solvers.size() == max_solvers) {
      // in a long session of swapped solvers, the one that has been silent longest is dropped
      pair.solvers.erase(
          std::min_element(pair.solvers.begin(), pair.solvers.end(),
                           [](const auto& x, const auto& y) { return x.at.mono_us < y.at.mono_us; }));
    }
    SolverTrack& track = pair.solvers.emplace_back();
    track.name = solver;
    if (pair.solvers.size() > 1 || pair.counted >= 0)
      note(Severity::info, name, "solver added: " + solver + " (" + method + ") answers as well", now);
    return track;
  }
  if (known->answer.method != method) {
    // the first answers of a fast solver are of another method, until it knows of the global solver or is
    // near the optimum
    if (known->settled || known->role != Role::fast)
      note(Severity::info, name,
           "solver swapped: " + solver + " changed from " + known->answer.method + " to " + method, now);
  } else if (known->silent) {
    note(Severity::good, name, solver + " answers again", now);
  }
  return *known;
}

void Model::on_calibration(const calibration_t& message, Now now, bool verified) {
  now_ = now;
  ++messages_;
  PairState* pair = find_pair(bounded(message.sensor_a), bounded(message.sensor_b));
  if (!pair) return;
  if (pair->has_problem ? message.session != pair->session : message.session < pair->session) return;
  if (!pair->has_problem && message.session != pair->session) begin_session(*pair, message.session);
  SolverTrack& track = track_of(*pair, message, now);
  const bool newer = track.answers == 0 || (verified && !track.verified) ||
                     (verified == track.verified && message.seq >= track.answer.seq);
  track.silent = false;
  track.at = now;
  ++track.answers;
  if (!newer) return;  // overtaken on the way

  track.answer = bounded_answer(message, *pair);
  track.verified = verified;
  track.role = role_of(track.answer);

  const double time = seconds_between(pair->session, message.utime);
  if (track.role == Role::global || message.fallback) {
    pair->only_fast_since.reset();
  } else if (!pair->only_fast_since && track.answer.status == 0) {
    pair->only_fast_since = time;
  }
  watch_fallback(*pair, track, message, now);

  // every solver's own course, so that two can be compared
  if (time >= 0 && time < options_.longest_session)
    track.history.add(time, curve_values(shown_of(*pair, message), message, track.role));
  count_answer(*pair, now);
}

/// Notices a fallback. A fast solver that starts has no answer to start from and asks for one; that is no
/// fallback.
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

/// Notices missing solvers: only if there is a problem to solve, and after a solver has had time for it.
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
