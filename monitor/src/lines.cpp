// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/lines.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "answer_text.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/diagnosis_json.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/loops.hpp"

namespace egocal::monitor {
namespace {

using nlohmann::json;

json real(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}
json reals(const double* values, int n) {
  json list = json::array();
  for (int i = 0; i < n; ++i) list.push_back(real(values[i]));
  return list;
}

const char* severity_name(Severity severity) {
  switch (severity) {
    case Severity::info:
      return "info";
    case Severity::good:
      return "good";
    case Severity::warning:
      return "warning";
    case Severity::bad:
      return "bad";
  }
  return "info";
}

std::string_view status_name(std::int8_t status) {
  return to_string(bus::optimality_from_wire(status).value_or(Optimality::undecided));
}

const char* reference_name(ReferenceKind kind) {
  return kind == ReferenceKind::truth ? "truth" : kind == ReferenceKind::nominal ? "nominal" : "none";
}

json answer_json(const PairState& pair, const SolverTrack& solver) {
  const calibration_t& answer = solver.answer;
  const Shown shown = shown_of(pair, answer);
  json j;
  j["solver"] = clean(solver.name, 100);
  j["role"] = solver.role == Role::global ? "global" : "fast";
  j["method"] = clean(answer.method, 100);
  j["session"] = answer.session;
  j["seq"] = answer.seq;
  j["pairs"] = answer.pairs;
  j["translation"] = reals(answer.pos, 3);
  j["rotation_wxyz"] = reals(answer.quat, 4);
  j["cost"] = real(answer.cost);
  j["lower_bound"] = real(answer.lower_bound);
  j["gap"] = real(answer.gap);
  j["scaled_gap"] = real(answer.scaled_gap);
  j["certified"] = answer.status == 0;
  j["status"] = status_name(answer.status);
  j["observable"] = json::array();
  for (const bool observable : shown.observability.observable) j["observable"].push_back(observable);
  j["stddev"] = reals(shown.observability.stddev.data(), 6);
  j["hint"] = clean(shown.observability.hint, 200);
  j["fallback"] = answer.fallback != 0;
  j["solve_us"] = static_cast<double>(answer.solve_ns) * 1e-3;
  j["verify_us"] = static_cast<double>(answer.verify_ns) * 1e-3;
  j["latency_us"] = answer.latency_us < 0 ? json(nullptr) : json(answer.latency_us);
  j["reference"] = reference_name(shown.reference);
  j["error_translation_m"] = real(shown.error_translation);
  j["error_rotation_deg"] = real(shown.error_rotation * degrees_per_radian);
  return j;
}

/// Adds the keys of the verdict, null where there is none.
void verdict_into(json& p, const PairState& pair) {
  for (const char* key : {"verdict", "reason", "fit", "findings", "goal"}) p[key] = nullptr;
  if (!pair.verdict) return;
  const Diagnosis& diagnosis = pair.verdict->diagnosis;
  p["verdict"] = to_string(diagnosis.verdict);
  p["reason"] = clean(diagnosis.reason, 400);
  if (pair.verdict->judged.poses > 0) p["fit"] = bus::fit_json(diagnosis.fit);
  p["findings"] = bus::findings_json(diagnosis.findings);
  if (diagnosis.goal) p["goal"] = bus::goal_json(*diagnosis.goal);
  p["verdict_seq"] = pair.verdict->seq;
  p["verdict_old"] = verdict_is_old(pair);
}

/// The scale of a pair; null where no scale is looked for, or none was received.
json scale_json(const PairState& pair) {
  if (!pair.scale) return nullptr;
  const ScaleSolution& solution = pair.scale->solution;
  return {{"sensor", clean(pair.scale->sensor, 40)},
          {"value", real(solution.scale)},
          {"stddev", real(solution.stddev)},
          {"least", real(solution.least_scale)},
          {"most", real(solution.most_scale)},
          {"certified", pair.scale->verified && solution.certified},
          {"verified", pair.scale->verified},
          {"observable", solution.observable},
          {"observability", real(solution.observability)},
          {"attenuation", real(solution.attenuation)},
          {"gap", real(solution.gap)}};
}

}  // namespace

std::string pair_lines(const Model& model, Charset charset) {
  const Symbols& s = symbols(charset);
  const std::string degree = charset == Charset::unicode ? "°" : " deg";
  std::string text;
  for (const PairState& pair : model.pairs()) {
    text += clean(pair.a, 40) + " -> " + clean(pair.b, 40) + ": ";
    const calibration_t* answer = pair.answer();
    if (!answer) {
      if (pair.scale && !pair.has_problem)
        text += "scale " + scale_text(*pair.scale, charset).text + "\n";
      else
        text +=
            pair.has_problem ? count(pair.problem.matched) + " motions, no answer yet\n" : "no motions yet\n";
      continue;
    }
    text += verdict_of(pair, charset).text;
    if (const std::string advice = advice_of(pair).text; !advice.empty()) text += ": " + clean(advice, 400);
    if (text.ends_with('.')) text.pop_back();
    text += "; " + proof_of(*answer).text + " by " + clean(answer->solver, 40) + " (" +
            clean(answer->method, 20) + "), " + std::to_string(answer->pairs) + " motions, ";
    if (pair.problem.left_out > 0) text += std::to_string(pair.problem.left_out) + " outliers, ";
    if (pair.problem.rejected > 0) text += std::to_string(pair.problem.rejected) + " rejected, ";
    if (pair_is_paused(model, pair)) text += "paused, ";
    if (session_has_no_motion(pair))
      text += "no new motion, ";
    else if (pairing_is_silent(pair))
      text +=
          pair.has_problem ? "pairing is silent, " : "pairing is silent: not verified without its problem, ";
    if (pair.shown.valid) {
      const Pose& T = pair.shown.T_a_b;
      const Eigen::Vector3d rpy = roll_pitch_yaw(T.rotation) * degrees_per_radian;
      const auto triple = [&](const Eigen::Vector3d& v, const double* spread, double scale) {
        std::string part;
        for (int i = 0; i < 3; ++i)
          part += (i ? " " : "") + number(v(i), 2, charset) + s.plus_minus +
                  number(spread[i] * scale, 2, charset);
        return part;
      };
      const double* const stddev = pair.shown.observability.stddev.data();
      text += "x y z " + triple(T.translation * 100, stddev, 100) + " cm, roll pitch yaw " +
              triple(rpy, stddev + 3, degrees_per_radian) + degree;
      if (pair.shown.reference != ReferenceKind::none)
        text += std::string(pair.shown.reference == ReferenceKind::truth ? ", error " : ", off nominal ") +
                number(pair.shown.error_translation * 100, 2, charset) + " cm " +
                number(pair.shown.error_rotation * degrees_per_radian, 3, charset) + degree;
    } else {
      text += "no transform: values that are not finite";
    }
    text += ", gap " + compact(answer->scaled_gap, charset) + " of 1, solve " +
            duration(static_cast<double>(answer->solve_ns) * 1e-9, charset) + " verify " +
            duration(static_cast<double>(answer->verify_ns) * 1e-9, charset);
    if (answer->latency_us >= 0) text += " end to end " + duration(to_seconds(answer->latency_us), charset);
    if (pair.scale) text += ", scale " + scale_text(*pair.scale, charset).text;
    if (const std::string& hint = pair.shown.observability.hint; !hint.empty())
      text += ", hint: " + clean(hint, 120);
    text += "\n";
  }
  return text;
}

std::string text_lines(const Model& model, Charset charset) {
  std::string text = pair_lines(model, charset);
  const std::vector<Loop> loops = loops_of(model);
  for (const Loop& loop : loops)
    text += "loop " + clean(loop.sensors[0], 40) + " " + clean(loop.sensors[1], 40) + " " +
            clean(loop.sensors[2], 40) + ": misfit " + centimetres(loop.translation, charset) + " " +
            degrees(loop.rotation, charset) +
            (loop.open() ? ", open: one of the three is wrong\n" : ", closed\n");
  if (const std::string sensor = sensor_to_blame(loops); !sensor.empty())
    text += "every open loop has " + clean(sensor, 40) + ": look at that sensor\n";
  for (const bus::StreamLine& line : model.streams())
    if (line.severity != bus::StreamLine::Severity::good) text += "stream " + clean(line.text, 400) + "\n";
  for (const ProcessState& process : model.processes()) {
    const status_t& status = process.status;
    text += clean(status.name, 40) + ": " +
            (!process.known                       ? "unknown (no network)"
             : process.computes                   ? "computes"
             : process.alive                      ? clean(status.state, 20)
             : process.state == bus::State::ended ? "ended"
                                                  : "GONE") +
            ", pid " + std::to_string(status.pid) + " on " + clean(status.host, 40) + ", in " +
            std::to_string(process.in) + " out " + std::to_string(process.out) + " lost " +
            std::to_string(process.lost) + " rejected " + std::to_string(process.rejected);
    if (!status.last_error.empty()) text += ", error: " + clean(status.last_error, 200);
    text += "\n";
  }
  return text;
}

std::string event_line(const Event& event, int utc_offset_s) {
  std::string text = clock_time(event.at.wall_us, utc_offset_s) + " " + clean(event.subject, 100) + ": " +
                     clean(event.text, 200);
  if (event.repeated > 1) text += " (" + std::to_string(event.repeated) + " times)";
  return text;
}

namespace {

json pair_json(const Model& model, const PairState& pair) {
  json p;
  p["a"] = clean(pair.a, 200);
  p["b"] = clean(pair.b, 200);
  p["session"] = pair.session;
  if (pair.has_problem) {
    p["mode"] = pair.problem.mode == 1 ? "planar" : "spatial";
    p["seq"] = pair.problem.seq;
    p["matched"] = pair.problem.matched;
    p["left_out"] = pair.problem.left_out;
    p["rejected"] = pair.problem.rejected;
    p["stride"] = pair.problem.stride;
    p["time_offset"] = real(pair.problem.time_offset);
    p["time_offset_stddev"] =
        pair.problem.time_offset_stddev < 0 ? json(nullptr) : real(pair.problem.time_offset_stddev);
  }
  p["paused"] = pair_is_paused(model, pair);
  p["answer_old"] = pair.old > 0;
  p["pairing_silent"] = pairing_is_silent(pair);
  p["ended"] = pair.ended;
  p["no_motion_s"] = real(pair.standing);
  p["only_fast_since"] = pair.only_fast_since ? real(*pair.only_fast_since) : json(nullptr);
  verdict_into(p, pair);
  p["scale"] = scale_json(pair);
  p["answer"] = pair.counted_solver() ? answer_json(pair, *pair.counted_solver()) : json(nullptr);
  p["previous_session"] = nullptr;
  if (pair.previous) {
    const calibration_t& answer = *pair.previous;
    p["previous_session"] = {{"session", answer.session},
                             {"utime", answer.utime},
                             {"pairs", answer.pairs},
                             {"translation", reals(answer.pos, 3)},
                             {"rotation_wxyz", reals(answer.quat, 4)},
                             {"stddev", reals(answer.stddev, 6)},
                             {"certified", answer.status == 0}};
  }
  p["solvers"] = json::array();
  for (const SolverTrack& solver : pair.solvers) p["solvers"].push_back(answer_json(pair, solver));
  return p;
}

void loops_into(json& j, const Model& model) {
  const std::vector<Loop> loops = loops_of(model);
  j["loops"] = json::array();
  for (const Loop& loop : loops)
    j["loops"].push_back(
        {{"sensors", {clean(loop.sensors[0], 200), clean(loop.sensors[1], 200), clean(loop.sensors[2], 200)}},
         {"rotation_deg", real(loop.rotation * degrees_per_radian)},
         {"translation_m", real(loop.translation)},
         {"rotation_limit_deg", real(loop.rotation_limit * degrees_per_radian)},
         {"translation_limit_m", real(loop.translation_limit)},
         {"open", loop.open()}});
  const std::string blamed = sensor_to_blame(loops);
  j["blamed"] = blamed.empty() ? json(nullptr) : json(clean(blamed, 200));
}

}  // namespace

std::string json_line(const Model& model) {
  json j;
  j["time_us"] = model.now().wall_us;
  j["pairs"] = json::array();
  for (const PairState& pair : model.pairs()) j["pairs"].push_back(pair_json(model, pair));
  loops_into(j, model);
  j["processes"] = json::array();
  for (const ProcessState& process : model.processes()) {
    const status_t& status = process.status;
    j["processes"].push_back({{"name", clean(status.name, 200)},
                              {"role", clean(status.role, 200)},
                              {"host", clean(status.host, 200)},
                              {"pid", status.pid},
                              {"alive", process.known ? json(process.alive) : json(nullptr)},
                              {"computes", process.computes},
                              {"state", clean(status.state, 200)},
                              {"in", process.in},
                              {"out", process.out},
                              {"lost", process.lost},
                              {"rejected", process.rejected},
                              {"last_error", clean(status.last_error, 200)}});
  }
  j["streams"] = json::array();
  for (const bus::StreamLine& line : model.streams())
    j["streams"].push_back(
        {{"ok", line.severity == bus::StreamLine::Severity::good}, {"text", clean(line.text, 400)}});
  j["events"] = json::array();
  const auto& events = model.events();
  const std::size_t first = events.size() > 20 ? events.size() - 20 : 0;
  for (std::size_t i = first; i < events.size(); ++i)
    j["events"].push_back({{"time_us", events[i].at.wall_us},
                           {"severity", severity_name(events[i].severity)},
                           {"subject", clean(events[i].subject, 200)},
                           {"text", clean(events[i].text, 200)},
                           {"repeated", events[i].repeated}});
  return j.dump();
}

}  // namespace egocal::monitor
