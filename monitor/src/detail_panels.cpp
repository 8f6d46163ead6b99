// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "answer_text.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/plot.hpp"
#include "number_cells.hpp"
#include "panels.hpp"

namespace egocal::monitor {

void draw_summary(const Pane& pane, const PairState& pair, Charset charset) {
  const Symbols& s = symbols(charset);
  const calibration_t* answer = pair.answer();
  const Label verdict = verdict_of(pair, charset);
  int x = pane.text(0, 0, verdict.text, verdict.style) + 1;
  if (answer) {
    const Label proof = proof_of(*answer);
    x = pane.text(x, 0, proof.text, proof.style) + 1;
    const std::string by = "by " + clean(answer->solver, 16),
                      gap = "  gap " + compact(answer->scaled_gap, charset);
    for (const std::string& text : {by + gap, by, "by " + short_solver(answer->solver)}) {
      if (x + width_of(text) > pane.width()) continue;
      pane.text(x, 0, text, Style::dim);
      break;
    }
  }
  if (!answer) {
    const std::vector<std::string> lines =
        wrapped(unanswered_text(pair, charset), static_cast<std::size_t>(std::max(1, pane.width())), 0);
    for (std::size_t i = 0; i < lines.size(); ++i)
      pane.text(0, 1 + static_cast<int>(i), lines[i], Style::dim);
  }
  if (!answer || !pair.shown.valid) return;
  const std::array<double, 6> values = components(pair.shown.T_a_b);
  for (int row = 0; row < 2; ++row) {
    std::string text = row == 0 ? "t" : "R";
    for (int i = 3 * row; i < 3 * row + 3; ++i)
      text += in_cells(values[static_cast<std::size_t>(i)] * scale_of(i), row == 0 ? 1 : 2, 8, charset);
    text += " " + std::string(s.plus_minus) +
            number(largest_stddev(pair.shown, static_cast<std::size_t>(3 * row)) * scale_of(3 * row),
                   row == 0 ? 1 : 2, charset);
    text += row == 0 ? " cm" : charset == Charset::unicode ? "°" : " deg";
    pane.text(0, 1 + row, text);
  }
  if (pair.shown.reference != ReferenceKind::none) {
    pane.text(0, 3,
              (pair.shown.reference == ReferenceKind::truth ? "error " : "off nominal ") +
                  centimetres(pair.shown.error_translation, charset) + "  " +
                  degrees(pair.shown.error_rotation, charset),
              Style::strong);
  } else {
    const Label advice = advice_of(pair);
    const std::string& hint = pair.shown.observability.hint;
    pane.text(0, 3, clean(advice.text.empty() ? hint : advice.text, 200),
              advice.text.empty() ? Style::warning : advice.style);
  }
}

namespace {

/// Of all six directions, where the motions show each of them.
const char* how_well_shown(const PairState& pair) {
  if (!pair.verdict) return "shown, but not judged yet";
  switch (pair.verdict->diagnosis.verdict) {
    case Verdict::good:
      return "the motions show everything";
    case Verdict::incomplete:
      return "shown, not yet exact enough";
    case Verdict::doubtful:
    case Verdict::contradictory:
      break;
  }
  return "shown, but see the verdict";
}

}  // namespace

void draw_observability(const Pane& pane, const PairState& pair, Charset charset) {
  const Symbols& s = symbols(charset);
  draw_title(pane, "Observability", charset);
  const calibration_t* answer = pair.answer();
  if (!answer) {
    pane.text(2, 1, "no answer yet", Style::dim);
    return;
  }
  constexpr int label_width = 8;                                  // columns of the screen
  const int number_width = charset == Charset::unicode ? 9 : 11;  // "±11.05 cm", "+-0.017 deg"
  const int length = std::max(4, pane.width() - label_width - number_width - 2);
  for (int i = 0; i < 6; ++i) {
    const int y = 1 + i;
    pane.text(2, y, direction_names[i], Style::normal);
    const bool ground = from_ground(pair, i);
    const bool known = shown_by_motion(pair.shown, i);
    // full bar: a millimetre or a hundredth of a degree; empty bar: a metre or 10 degrees
    const double stddev = pair.shown.observability.stddev[static_cast<std::size_t>(i)];
    const double doubt = stddev * (i < 3 ? 1.0 : degrees_per_radian / 10.0);
    double filled =
        known && doubt >= 0 ? std::clamp(-std::log10(std::max(doubt, 1e-9)) / 3.0, 0.0, 1.0) : 0.0;
    if (ground) filled = 0;
    const Style style = ground         ? Style::dim
                        : !known       ? Style::bad
                        : filled < 0.4 ? Style::warning
                                       : Style::good;
    const int full = static_cast<int>(std::lround(filled * length));
    for (int k = 0; k < length; ++k)
      pane.text(label_width + k, y, k < full ? s.bar_full : s.bar_empty, k < full ? style : Style::dim);
    const std::string text = ground   ? "plane"
                             : !known ? "not shown"
                             : i < 3  ? distance_in(number_width, s.plus_minus + centimetres(stddev, charset),
                                                    stddev, charset, s.plus_minus)
                                      : s.plus_minus + degrees(stddev, charset);
    pane.text(label_width + length + 1, y, pad_left(text, number_width),
              known || ground ? Style::dim : Style::bad);
  }
  const std::string& hint = pair.shown.observability.hint;
  const std::string missing = missing_directions(pair);
  if (!hint.empty())
    pane.text(2, 7, clean(hint, 120), Style::warning);
  else if (!missing.empty())  // no motion would show them
    pane.text(2, 7, "neither stream measures " + missing, Style::warning);
  else
    pane.text(2, 7, how_well_shown(pair), Style::dim);
}

void draw_solvers(const Pane& pane, const PairState& pair, Now now, Charset charset) {
  const Symbols& s = symbols(charset);
  draw_title(pane, "Solvers", charset);
  if (pair.solvers.empty()) {
    pane.text(2, 1, "no answer yet", Style::dim);
    return;
  }
  constexpr int label_width = 10, narrow_width = 10;  // columns of the screen
  const int room = pane.width() - label_width;
  const int columns =
      std::min<int>({static_cast<int>(pair.solvers.size()), std::max(1, room / narrow_width), 3});
  const int w = std::min(20, room / columns);
  const int indent = w >= 14 ? 2 : 0;
  // always in the same place; without room for all, the most recent ones
  std::vector<const SolverTrack*> order;
  for (const SolverTrack& solver : pair.solvers) order.push_back(&solver);
  std::sort(order.begin(), order.end(),
            [](const SolverTrack* x, const SolverTrack* y) { return x->name < y->name; });
  if (static_cast<int>(order.size()) > columns)
    std::sort(order.begin(), order.end(),
              [](const SolverTrack* x, const SolverTrack* y) { return x->at.mono_us > y->at.mono_us; });

  // the transforms too, if there is room: do both solvers agree?
  const bool transforms = pane.height() >= 2 + 11 + 6;
  const bool spread_rows = pair.shown.reference == ReferenceKind::none;
  std::vector<std::string> labels{"method", "optimal", "gap",
                                  spread_rows ? s.plus_minus + std::string(" t") : "error t",
                                  spread_rows ? s.plus_minus + std::string(" R") : "error R"};
  if (transforms) labels.insert(labels.end(), std::begin(direction_names), std::end(direction_names));
  for (const char* label : {"cost", "solve", "verify", "total", "motions", "age"}) labels.emplace_back(label);
  for (std::size_t i = 0; i < labels.size(); ++i)
    pane.text(2, 2 + static_cast<int>(i), pad_right(labels[i], label_width - 3), Style::dim);

  for (int c = 0; c < columns; ++c) {
    const SolverTrack& solver = *order[static_cast<std::size_t>(c)];
    const calibration_t& answer = solver.answer;
    const Shown own = shown_of(pair, answer);
    const Pane column = pane.part({label_width + c * w, 0, w - 1, pane.height()});
    const std::string mark = &solver == pair.counted_solver() ? s.cursor : " ";
    column.text(0, 1, mark + (indent ? " " : "") + short_solver(solver.name), solver_style(solver.role));
    int row = 2;
    const int cells = column.width() - indent;
    const auto value = [&](const std::string& text, Style style = Style::normal) {
      column.text(indent, row++, text, style);
    };
    const bool referenced = own.reference != ReferenceKind::none;
    value(clean(answer.method, 9));
    if (answer.status == 0)
      value("proven", Style::good);
    else
      value(answer.status == 1 ? "no" : "undecided", answer.status == 1 ? Style::bad : Style::warning);
    value(compact(answer.scaled_gap, charset));
    const double off = referenced ? own.error_translation : largest_stddev(own, 0);
    value(distance_in(cells, centimetres(off, charset), off, charset));
    value(degrees(referenced ? own.error_rotation : largest_stddev(own, 3), charset));
    if (transforms) {
      const std::array<double, 6> values = components(own.T_a_b);
      for (int i = 0; i < 6; ++i) {
        const double v = values[static_cast<std::size_t>(i)];
        const std::string unit = i < 3 ? " cm" : charset == Charset::unicode ? "°" : indent ? " deg" : "";
        const std::string text = number(v * scale_of(i), i < 3 ? 2 : 3, charset) + unit;
        value(!own.valid ? "-" : i < 3 ? distance_in(cells, text, v, charset) : text);
      }
    }
    value(compact(answer.cost, charset));
    value(solve_time(answer, charset));
    value(verify_time(answer, charset));
    value(latency(answer, charset));
    value(count(answer.pairs));
    value(answer_age(pair, solver, now), solver.silent ? Style::bad : Style::dim);
  }
}

void draw_direction(const Pane& pane, const PairState& pair, bool inverted, bool matrix, Charset charset) {
  constexpr int words = 16;  // cells of the title beside the two names
  const auto most = static_cast<std::size_t>(std::clamp((pane.width() - words) / 2, 3, 16));
  const std::string from = clean_name(inverted ? pair.b : pair.a, most),
                    to = clean_name(inverted ? pair.a : pair.b, most);
  draw_title(pane, "pose of " + to + " in " + from, charset);
  const calibration_t* answer = pair.answer();
  if (!answer || !pair.shown.valid) {
    pane.text(2, 1, "no answer yet", Style::dim);
    return;
  }
  const Pose T = inverted ? inverse(pair.shown.T_a_b) : pair.shown.T_a_b;
  const int w = pane.width();
  constexpr int start = 8, wide = 10, narrow = 8;  // cells
  const bool roomy = w >= start + 4 * wide;
  const auto row = [&](int y, const char* label, const std::vector<double>& values, int decimals,
                       const char* unit) {
    pane.text(1, y, label, Style::dim);
    const int room = (w - start) / static_cast<int>(values.size()),
              cell = roomy ? wide : std::clamp(room, 6, narrow);
    int x = start;
    for (const double value : values) x = pane.text(x, y, in_cells(value, decimals, cell, charset));
    pane.text(x + 1, y, unit, Style::dim);
  };
  const Eigen::Vector3d t = T.translation * centimetres_per_metre,
                        rpy = roll_pitch_yaw(T.rotation) * degrees_per_radian;
  const Eigen::Quaterniond& q = T.rotation;
  // decimals of what lies between -1 and 1
  const int fine = (roomy ? wide : std::clamp((w - start) / 4, 6, narrow)) - 4;
  row(1, "x y z", {t.x(), t.y(), t.z()}, 2, "cm");
  row(2, "q wxyz", {q.w(), q.x(), q.y(), q.z()}, fine, "");
  row(3, "r p y", {rpy.x(), rpy.y(), rpy.z()}, 3, symbols(charset).degree);
  if (!matrix) return;
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  for (int i = 0; i < 3; ++i)
    row(4 + i, i == 0 ? "R | t" : "", {R(i, 0), R(i, 1), R(i, 2), T.translation(i)}, fine, i == 0 ? "m" : "");
}

void draw_curve(const Pane& pane, const PairState& pair, int curve, const ViewState& view) {
  const bool unicode = view.charset == Charset::unicode;
  Plot plot;
  plot.curve = static_cast<Curve>(curve);
  plot.logarithmic = view.logarithmic;
  const char* kind = pair.shown.reference == ReferenceKind::truth     ? "error"
                     : pair.shown.reference == ReferenceKind::nominal ? "off nominal"
                                                                      : "spread";
  const bool fast_alone =
      plot.curve == scaled_gap &&
      std::any_of(pair.solvers.begin(), pair.solvers.end(), [](const SolverTrack& solver) {
        return solver.role == Role::fast && !solver.history.empty();
      });
  switch (plot.curve) {
    case rotation_error:
      plot.title = std::string("rotation ") + kind + (unicode ? " [°]" : " [deg]");
      plot.scale = degrees_per_radian;
      break;
    case translation_error:
      plot.title = std::string("translation ") + kind + " [cm]";
      plot.scale = centimetres_per_metre;
      break;
    case scaled_gap:
      // the gap of the global solution is zero; the interesting one is how close the fast solver is to asking
      // for it
      plot.title =
          pane.width() >= 44
              ? "scaled gap of the " + std::string(fast_alone ? "fast" : "global") + " solution (limit 1)"
          : pane.width() >= 30 ? "scaled gap, " + std::string(fast_alone ? "fast" : "global") + " (limit 1)"
                               : "scaled gap (limit 1)";
      plot.threshold = 1.0;
      break;
    default:
      plot.title = std::string("execution time [") + symbols(view.charset).micro + "s]";
      plot.scale = 1e6;
      break;
  }
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const SolverTrack& solver : pair.solvers) {
    if (solver.history.empty() || (fast_alone && solver.role != Role::fast)) continue;
    first = std::min(first, solver.history.first_time());
    last = std::max(last, solver.history.last_time());
    plot.series.push_back({&solver.history, solver_style(solver.role)});
  }
  if (!(first <= last)) {
    plot.begin = 0;
    plot.end = 1;
  } else {
    plot.end = last;
    plot.begin = view.window_s > 0 ? std::max(first, last - view.window_s) : first;
    if (plot.end - plot.begin < 1) plot.end = plot.begin + 1;
  }
  // the fast solver lasts, so its curve is drawn last, on top
  std::stable_sort(plot.series.begin(), plot.series.end(), [](const auto& x, const auto& y) {
    return x.style == Style::global && y.style != Style::global;
  });
  plot.mark = pair.only_fast_since;
  if (pair.verdict)
    for (const Finding& finding : pair.verdict->diagnosis.findings)
      if (finding.code == "mount_moved" && finding.time)
        plot.moves.push_back(seconds_between(pair.session, pair.verdict->judged.begin_us) + *finding.time);
  if (plot.curve == execution_time && plot.mark) plot.mark_label = "fast alone";
  draw_plot(pane, plot, view.charset);
}

}  // namespace egocal::monitor
