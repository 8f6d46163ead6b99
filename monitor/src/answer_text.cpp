// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "answer_text.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/microseconds.hpp"

namespace egocal::monitor {

std::string bounded(const std::string& text) {
  return text.substr(0, Model::max_text);
}

bool sums_strides(const problem_t& problem) {
  return problem.choice.starts_with("sum over strides");  // docs/json.md
}

std::string stride_text(const problem_t& problem) {
  return sums_strides(problem) ? "many strides" : "stride " + std::to_string(problem.stride);
}

double scale_of(int direction) {
  return direction < 3 ? centimetres_per_metre : degrees_per_radian;
}

bool from_ground(const PairState& pair, int direction) {
  return pair.has_problem && pair.problem.mode == 1 && direction >= 2 && direction <= 4;
}

bool shown_by_motion(const Shown& shown, int direction) {
  return shown.observability.observable[static_cast<std::size_t>(direction)];
}

std::array<double, 6> components(const Pose& T) {
  const Eigen::Vector3d rpy = roll_pitch_yaw(T.rotation);
  return {T.translation.x(), T.translation.y(), T.translation.z(), rpy.x(), rpy.y(), rpy.z()};
}

std::string spread(const PairState& pair, int direction, int decimals, Charset charset) {
  if (from_ground(pair, direction)) return "plane";
  const double value =
      pair.shown.observability.stddev[static_cast<std::size_t>(direction)] * scale_of(direction);
  return symbols(charset).plus_minus + number(value, value < 10 ? decimals : decimals - 1, charset);
}

std::string centimetres(double metres, Charset charset) {
  const double value = metres * centimetres_per_metre;
  return number(value, std::abs(value) < 100 ? 2 : 1, charset) + " cm";
}
std::string degrees(double radians, Charset charset) {
  const double value = radians * degrees_per_radian;
  return number(value, std::abs(value) < 10 ? 3 : 1, charset) + (charset == Charset::unicode ? "°" : " deg");
}

double largest(const double* values) {
  return std::max({values[0], values[1], values[2]});
}

double largest_stddev(const Shown& shown, std::size_t from) {
  return largest(shown.observability.stddev.data() + from);
}

std::string missing_directions(const PairState& pair) {
  std::string text;
  for (int i = 0; i < 6; ++i)
    if (!shown_by_motion(pair.shown, i) && !from_ground(pair, i))
      text += (text.empty() ? "" : " ") + std::string(direction_names[i]);
  return text;
}

std::string latency(const calibration_t& answer, Charset charset) {
  return answer.latency_us < 0 ? "-" : duration(to_seconds(answer.latency_us), charset);
}
std::string solve_time(const calibration_t& answer, Charset charset) {
  return duration(static_cast<double>(answer.solve_ns) * 1e-9, charset);
}
std::string verify_time(const calibration_t& answer, Charset charset) {
  return duration(static_cast<double>(answer.verify_ns) * 1e-9, charset);
}

namespace {

Style style_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::good:
      return Style::good;
    case Verdict::incomplete:
      return Style::normal;
    case Verdict::doubtful:
      return Style::warning;
    case Verdict::contradictory:
      break;
  }
  return Style::bad;
}

const char* mark_of(Verdict verdict, const Symbols& s) {
  switch (verdict) {
    case Verdict::good:
      return s.yes;
    case Verdict::incomplete:
      return s.gone;
    case Verdict::doubtful:
      return "?";
    case Verdict::contradictory:
      break;
  }
  return s.no;
}

std::string words(const std::vector<std::string>& directions) {
  std::string text;
  for (const std::string& direction : directions) text += (text.empty() ? "" : " ") + direction;
  return text;
}

}  // namespace

bool verdict_is_old(const PairState& pair) {
  return pair.verdict && (pair.verdict->old > 0 || departure_of(pair));
}

Label verdict_of(const PairState& pair, Charset charset) {
  const Symbols& s = symbols(charset);
  const calibration_t* answer = pair.answer();
  if (!answer) return {pair.has_problem ? "solving" : "waiting", Style::dim};
  if (!pair.shown.valid) return {std::string(s.no) + " unusable", Style::bad};
  if (!pair.verdict) return {"not judged yet", Style::dim};
  const Verdict verdict = pair.verdict->diagnosis.verdict;
  // newer motions may contradict the answer; a contradictory one stays contradictory
  if (verdict <= Verdict::incomplete && pair.old > 0) return {"? old answer", Style::warning};
  if (verdict <= Verdict::incomplete && verdict_is_old(pair)) return {"? old verdict", Style::warning};
  // the answer is right for its motions, but no new ones are found
  if (verdict <= Verdict::incomplete && pair.standing > 0 && !pair.why_standing.empty())
    return {"? no motion", Style::warning};
  // a monitor that came when pairing was gone already
  if (verdict <= Verdict::incomplete && !pair.counted_solver()->verified)
    return {"? not verified", Style::warning};
  // a verdict is about the optimum, so it does not hold for an answer that is not proven to be it
  if (verdict <= Verdict::incomplete && answer->status != 0) return {"? not proven", Style::warning};
  return {std::string(mark_of(verdict, s)) + " " + std::string(to_string(verdict)), style_of(verdict)};
}

Label proof_of(const calibration_t& answer) {
  if (answer.status == 0) return {"optimal (proven)", Style::good};
  if (answer.status == 1) return {"not optimal", Style::bad};
  return {"optimum undecided", Style::warning};
}

std::string goal_text(const Diagnosis& diagnosis) {
  if (!diagnosis.goal) return {};
  const Goal& goal = *diagnosis.goal;
  if (goal.reached) return "done";
  std::string text = goal.missing.size() == 6 ? "collecting" : "weak: " + words(goal.missing);
  if (goal.seconds_left && *goal.seconds_left < 1e6)
    text += ", about " + age(std::max(1.0, *goal.seconds_left)) + " more of this";
  else
    text += ", more of this does not help";
  return goal.next.empty() ? text : text + ". " + goal.next;
}

std::string with_cure(const Finding& finding) {
  return finding.message + (finding.remedy.empty() ? "" : " Cure: " + finding.remedy);
}

namespace {

/// ". Before: good. The motions agree."
std::string before_that(const PairState& pair) {
  if (!pair.verdict) return {};
  const Diagnosis& diagnosis = pair.verdict->diagnosis;
  return ". Before: " + std::string(to_string(diagnosis.verdict)) + ". " + diagnosis.reason;
}

}  // namespace

std::string unanswered_text(const PairState& pair, Charset charset) {
  if (pair.has_problem)
    return "motions arrive (" + count(pair.problem.matched) + " so far), no solver has answered yet";
  if (pair.scale) return "scale " + scale_text(*pair.scale, charset).text;
  return "no motions yet: is the odometry of both sensors coming in, and pairing running?";
}

std::string answer_age(const PairState& pair, const SolverTrack& solver, Now now) {
  // while pairing is silent solvers repeat their answers
  const double without_motion =
      pair.silent && pair.has_problem ? seconds_between(pair.motion_mono_us, now.mono_us) : 0;
  return age(
      std::max({seconds_between(solver.at.mono_us, now.mono_us), pair.standing, pair.old, without_motion}));
}

std::string standing_text(const PairState& pair) {
  return "no new motion for " + age(pair.standing) + (pair.why_standing.empty() ? "" : ": ") +
         pair.why_standing;
}

Label advice_of(const PairState& pair) {
  if (pair.old > 0)
    return {(pair.no_network               ? "no network, nothing received for " + age(pair.old)
             : session_has_no_motion(pair) ? "no new motion for " + age(pair.old) + ": " + pair.why_standing
             : pairing_is_silent(pair)     ? "pairing is silent for " + age(pair.old)
                                           : "no solver answers what came in the last " + age(pair.old)) +
                before_that(pair),
            Style::warning};
  if (pair.standing > 0 && !pair.why_standing.empty())
    return {standing_text(pair) + before_that(pair), Style::warning};
  if (!pair.verdict) return {"", Style::dim};
  const Diagnosis& diagnosis = pair.verdict->diagnosis;
  if (pair.verdict->old > 0)
    return {"nothing has been judged for " + age(std::max(1.0, pair.verdict->old)) +
                ": is egocal-diagnosis running?" + before_that(pair).substr(1),
            Style::warning};
  if (const std::optional<bus::Departure> moved = departure_of(pair))
    return {bus::in_words(*moved) + before_that(pair), Style::warning};
  const Style style = style_of(diagnosis.verdict);
  for (const Finding& finding : diagnosis.findings)
    if (finding.certain) return {with_cure(finding), style};
  if (diagnosis.verdict >= Verdict::doubtful && !diagnosis.findings.empty())
    return {with_cure(diagnosis.findings.front()), style};
  if (diagnosis.verdict <= Verdict::incomplete && diagnosis.goal && !diagnosis.goal->reached)
    return {"goal " + goal_text(diagnosis), style};
  return {std::string(pair.ended ? "pairing has ended, this is its last answer. " : "") +
              (diagnosis.goal && diagnosis.goal->reached ? "goal done. " : "") + diagnosis.reason,
          style};
}

std::string fit_text(const PairVerdict& verdict, Charset charset) {
  const Fit& fit = verdict.diagnosis.fit;
  if (verdict.judged.poses == 0) return {};
  return degrees(fit.rotation_median, charset) + ", " + centimetres(fit.translation_median, charset) + " (" +
         number(100 * fit.translation_relative_median, 1, charset) + " % of the way) a motion of " +
         number(fit.motion_seconds, 1, charset) + " s; 95 % below " + degrees(fit.rotation_95, charset) +
         ", " + centimetres(fit.translation_95, charset) + "; lengths b / a " +
         number(fit.length_ratio, 3, charset);
}

Label scale_text(const bus::CheckedScale& scale, Charset charset) {
  const ScaleSolution& solution = scale.solution;
  const std::string sensor = clean(scale.sensor, 40);
  if (!scale.verified)
    return {"of " + sensor + " not verified: its problem was not received", Style::warning};
  if (solution.at_limit)
    return {"of " + sensor + " not found: " + compact(solution.scale, charset) +
                " is the end of the range that is searched",
            Style::warning};
  if (!solution.observable || !std::isfinite(solution.stddev))
    return {"of " + sensor + " not shown by the motions yet: drive on, with curves", Style::warning};
  const double percent = 100 * solution.stddev / solution.scale;
  return {compact(solution.scale, charset) + " of " + sensor + " " + symbols(charset).plus_minus +
              number(percent, percent < 1 ? 3 : 1, charset) + " %, " +
              (solution.certified ? "optimal (proven)" : "not proven"),
          solution.certified ? Style::good : Style::warning};
}

std::string pair_title(const PairState& pair, Charset charset, std::size_t max) {
  return clean_name(pair.a, max) + " " + symbols(charset).arrow + " " + clean_name(pair.b, max);
}

std::string pair_in(const std::string& a, const std::string& b, int cells, Charset charset) {
  const std::string arrow = std::string(" ") + symbols(charset).arrow + " ";
  const int room = std::max(2, cells - width_of(arrow));
  const int first = width_of(clean(a, Model::max_text)), second = width_of(clean(b, Model::max_text));
  const int of_a =
      first + second <= room ? first : std::clamp(room - second, room / 2, std::max(room / 2, first));
  const auto part = [](const std::string& name, int width) {
    return clean_name(name, static_cast<std::size_t>(std::max(1, width)));
  };
  return part(a, std::min(first, of_a)) + arrow + part(b, room - std::min(first, of_a));
}

std::string short_solver(const std::string& name, std::size_t max) {
  const std::string prefix = "egocal-";
  return clean(name.rfind(prefix, 0) == 0 && name.size() > prefix.size() ? name.substr(prefix.size()) : name,
               max);
}

Style solver_style(Role role) {
  return role == Role::global ? Style::global : Style::fast;
}

}  // namespace egocal::monitor
