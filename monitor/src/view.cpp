// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/view.hpp"

#include <algorithm>
#include <vector>

#include "answer_text.hpp"
#include "dialog.hpp"
#include "egocal/bus/backing.hpp"
#include "egocal/monitor/layout.hpp"
#include "panels.hpp"
#include "selection.hpp"

namespace egocal::monitor {
namespace {

void draw_header(const Pane& pane, const Model& model, const ViewState& view) {
  if (pane.height() < 1) return;
  const Symbols& s = symbols(view.charset);
  const PairState* pair = selected_pair(model, view);
  int x = 1;
  std::string right = clock_time(model.now().wall_us, view.utc_offset_s);
  if (view.frozen) right = "VIEW PAUSED  " + right;
  // items from left to right as far as there is room before the clock
  const int end = pane.width() - (pane.width() >= 40 || view.frozen ? width_of(right) + 3 : 0);
  constexpr const char* no_network = "NO NETWORK";
  // before the clock: nothing else here is of the present
  const bool away = !view.network_error.empty();
  const auto say_away = [&] {
    if (away && x + width_of(no_network) <= pane.width()) x = pane.text(x, 0, no_network, Style::bad) + 2;
  };
  const auto item = [&](const std::string& text, Style style) {
    if (x + width_of(text) > end) return false;
    x = pane.text(x, 0, text, style);
    return true;
  };
  if (view.screen == Screen::detail && pair) {
    x = pane.text(x, 0, pair_title(*pair, view.charset, pane.width() >= 60 ? 24 : 12), Style::title) + 2;
    const bool paused = pair_is_paused(model, *pair);
    say_away();
    if (paused) item("PAUSED ", Style::warning);
    const Label verdict = verdict_of(*pair, view.charset);
    item(verdict.text, verdict.style);
    const std::string between = std::string(" ") + s.dot + " ";
    const calibration_t* answer = pair->answer();
    if (answer && x + 4 + width_of(clean(answer->solver, 16)) <= end) {
      item(" by ", Style::dim);
      item(clean(answer->solver, 16), solver_style(pair->counted_solver()->role));
    }
    if (answer) {
      item(between + count(answer->pairs) + " frames", Style::dim);
    }
    if (pair->has_problem) {
      const problem_t& problem = pair->problem;
      if (problem.left_out > 0) item(between + count(problem.left_out) + " outliers", Style::warning);
      if (problem.rejected > 0) item(between + count(problem.rejected) + " rejected", Style::dim);
      item(between + (problem.mode == 1 ? "planar" : "3-D"), Style::dim);
      std::string offset = number(problem.time_offset * 1e3, 1, view.charset);
      if (problem.time_offset_stddev >= 0)
        offset += " " + std::string(s.plus_minus) + number(problem.time_offset_stddev * 1e3, 1, view.charset);
      item(between + "offset " + offset + " ms", Style::dim);
      item(between + stride_text(problem), Style::dim);
    }
  } else {
    x = pane.text(x, 0, "egocal", Style::title) + 2;
    std::size_t good = 0, certified = 0, gone = 0, paused = 0;
    for (const PairState& p : model.pairs()) paused += pair_is_paused(model, p);
    for (const PairState& p : model.pairs()) certified += p.answer() && p.answer()->status == 0;
    for (const PairState& p : model.pairs()) good += is_good(p);
    const auto old = std::count_if(model.pairs().begin(), model.pairs().end(),
                                   [](const PairState& p) { return p.old > 0; });
    for (const ProcessState& p : model.processes()) gone += !p.alive && p.state != bus::State::ended;
    x = pane.text(x, 0, std::to_string(good) + " of " + std::to_string(model.pairs().size()) + " good",
                  good == model.pairs().size() && good ? Style::good : Style::normal) +
        2;
    // a pair that is so may be below the last row
    const auto contradictory =
        std::count_if(model.pairs().begin(), model.pairs().end(), [](const PairState& p) {
          return p.verdict && p.verdict->diagnosis.verdict == Verdict::contradictory;
        });
    say_away();
    if (contradictory > 0 && item(std::to_string(contradictory) + " contradictory", Style::bad)) x += 2;
    if (old > 0 && item(std::to_string(old) + " old", Style::warning)) x += 2;
    if (pane.width() >= 50)
      x = pane.text(x, 0, std::to_string(certified) + " proven optimal",
                    certified == model.pairs().size() && certified && !old ? Style::good : Style::normal) +
          2;
    if (gone) x = pane.text(x, 0, std::to_string(gone) + " gone", Style::bad) + 2;
    if (paused)
      x = pane.text(x, 0, paused == model.pairs().size() ? "PAUSED" : std::to_string(paused) + " PAUSED",
                    Style::warning) +
          2;
    if (pane.width() >= 70) right = clean(view.source, 40) + "  " + right;
  }
  const int at = pane.width() - width_of(right) - 1;
  if (at > x) pane.text(at, 0, right, view.frozen ? Style::warning : Style::dim);
}

void draw_keys(const Pane& pane, const ViewState& view) {
  if (pane.height() < 1) return;
  if (!view.notice.empty()) {
    pane.text(1, 0, clean(view.notice, 200), Style::warning);
    return;
  }
  struct Hint {
    const char* key;
    const char* does;
  };
  std::vector<Hint> hints;
  switch (view.screen) {
    case Screen::overview:
      hints = {{"q", "quit"},   {"?", "help"},    {"Enter", "detail"},
               {"e", "events"}, {"s", "streams"}, {"space", "pause view"},
               {"x", "export"}, {"r", "reset"},   {"p", "pause calibration"}};
      break;
    case Screen::detail:
      hints = {{"q", "quit"},           {"?", "help"},   {"Esc", "back"}, {"+-", "zoom"}, {"l", "log/linear"},
               {"space", "pause view"}, {"x", "export"}, {"r", "reset"},  {"p", "pause"}, {"n", "next pair"}};
      break;
    case Screen::events:
    case Screen::streams:
      hints = {{"q", "quit"}, {"?", "help"}, {"Esc", "back"}, {"up/down", "scroll"}, {"space", "pause view"}};
      break;
  }
  int x = 1;
  for (const Hint& hint : hints) {
    const int w = width_of(hint.key) + 1 + width_of(hint.does);
    if (x + w > pane.width()) break;
    x = pane.text(x, 0, hint.key, Style::key) + 1;
    x = pane.text(x, 0, hint.does, Style::dim) + 3;
  }
}

/// On the overview only what is not as it should be; all of it has a screen of its own.
int streams_to_say(const Model& model) {
  const auto& lines = model.streams();
  const bool well = std::all_of(lines.begin(), lines.end(), [](const bus::StreamLine& line) {
    return line.severity == bus::StreamLine::Severity::good;
  });
  return well ? 0 : static_cast<int>(lines.size());
}

void draw_overview(Canvas& canvas, const Model& model, const ViewState& view) {
  const OverviewLayout layout =
      layout_overview(canvas.width(), canvas.height(), static_cast<int>(model.pairs().size()),
                      static_cast<int>(model.processes().size()), streams_to_say(model));
  draw_header(Pane(canvas, layout.header), model, view);
  const Pane pairs(canvas, layout.pairs);
  const int top = layout.titles ? 1 : 0;
  if (layout.titles) draw_title(pairs, "Sensor pairs", view.charset);
  const Pane rows = pairs.part({0, top, pairs.width(), pairs.height() - top});
  if (layout.card_rows > 0 && !model.pairs().empty()) {
    for (std::size_t i = 0; i < model.pairs().size(); ++i)
      draw_pair_card(rows.part({0, static_cast<int>(i) * layout.card_rows, rows.width(), layout.card_rows}),
                     model.pairs()[i], model.now(), static_cast<int>(i) == view.selected,
                     pair_is_paused(model, model.pairs()[i]), view.charset);
  } else {
    draw_pair_table(rows, model, view.selected, layout.titles, view.charset);
  }
  if (!layout.summary.empty())
    if (const PairState* pair = selected_pair(model, view))
      draw_summary(Pane(canvas, layout.summary), *pair, view.charset);
  if (!layout.streams.empty()) draw_streams(Pane(canvas, layout.streams), model, 0, false, view.charset);
  if (!layout.processes.empty())
    draw_processes(Pane(canvas, layout.processes), model, layout.titles, view.charset);
  if (!layout.events.empty()) {
    const Pane events(canvas, layout.events);
    draw_title(events, "Events", view.charset);
    draw_events(events.part({0, 1, events.width(), events.height() - 1}), model, 0, view.utc_offset_s,
                view.charset);
  }
  draw_keys(Pane(canvas, layout.keys), view);
}

void draw_detail(Canvas& canvas, const Model& model, const ViewState& view) {
  const PairState* pair = selected_pair(model, view);
  const DetailLayout layout = layout_detail(canvas.width(), canvas.height());
  draw_header(Pane(canvas, layout.header), model, view);
  draw_keys(Pane(canvas, layout.keys), view);
  if (!pair) {
    Pane(canvas).text(1, layout.header.h, "no pair yet: waiting for messages", Style::dim);
    return;
  }
  if (!layout.verdict.empty()) draw_verdict(Pane(canvas, layout.verdict), *pair, view.charset);
  if (!layout.summary.empty()) draw_summary(Pane(canvas, layout.summary), *pair, view.charset);
  for (int i = 0; i < 4; ++i)
    if (const Rect& rect = layout.plots[static_cast<std::size_t>(i)]; !rect.empty())
      draw_curve(Pane(canvas, rect), *pair, i, view);
  if (!layout.observability.empty())
    draw_observability(Pane(canvas, layout.observability), *pair, view.charset);
  if (!layout.solvers.empty()) draw_solvers(Pane(canvas, layout.solvers), *pair, model.now(), view.charset);
  for (int i = 0; i < 2; ++i)
    if (const Rect& rect = layout.directions[static_cast<std::size_t>(i)]; !rect.empty())
      draw_direction(Pane(canvas, rect), *pair, i == 1, layout.matrices, view.charset);
}

void draw_event_screen(Canvas& canvas, const Model& model, const ViewState& view) {
  const EventsLayout layout = layout_events(canvas.width(), canvas.height());
  draw_header(Pane(canvas, layout.header), model, view);
  draw_keys(Pane(canvas, layout.keys), view);
  const Pane list(canvas, layout.list);
  if (event_rows(list.height()) == list.height()) {
    draw_events(list, model, view.scroll, view.utc_offset_s, view.charset);
    return;
  }
  draw_title(list, "Events", view.charset);
  draw_events(list.part({0, 1, list.width(), list.height() - 1}), model, view.scroll, view.utc_offset_s,
              view.charset);
}

void draw_stream_screen(Canvas& canvas, const Model& model, const ViewState& view) {
  const EventsLayout layout = layout_events(canvas.width(), canvas.height());
  draw_header(Pane(canvas, layout.header), model, view);
  draw_keys(Pane(canvas, layout.keys), view);
  draw_streams(Pane(canvas, layout.list), model, view.scroll, true, view.charset);
}

}  // namespace

void draw(Canvas& canvas, const Model& model, const ViewState& view) {
  switch (view.screen) {
    case Screen::overview:
      draw_overview(canvas, model, view);
      break;
    case Screen::detail:
      draw_detail(canvas, model, view);
      break;
    case Screen::events:
      draw_event_screen(canvas, model, view);
      break;
    case Screen::streams:
      draw_stream_screen(canvas, model, view);
      break;
  }
  draw_dialog(canvas, selected_pair(model, view), view);
}

std::optional<NamedExtrinsic> extrinsic_of(const PairState& pair) {
  const calibration_t* answer = pair.answer();
  if (!answer || !pair.shown.valid) return std::nullopt;
  NamedExtrinsic extrinsic;
  extrinsic.parent = pair.a;
  extrinsic.child = pair.b;
  extrinsic.T_parent_child = pair.shown.T_a_b;
  extrinsic.certified = answer->status == 0;
  extrinsic.pairs = answer->pairs;
  if (pair.verdict) {
    extrinsic.verdict = to_string(pair.verdict->diagnosis.verdict);
    extrinsic.reason = pair.verdict->diagnosis.reason;
    extrinsic.usable = pair.verdict->diagnosis.verdict != Verdict::contradictory;
  }
  if (pair.old > 0) extrinsic.usable = false;
  extrinsic.stddev.emplace();
  std::copy_n(answer->stddev, 6, extrinsic.stddev->begin());
  Observability shown;
  for (std::size_t i = 0; i < 6; ++i) shown.observable[i] = answer->observable[i] != 0;
  shown.hint = answer->hint;
  const bool planar = answer->method == "planar" || (pair.has_problem && pair.problem.mode == 1);
  extrinsic.backing = bus::backing_of(shown, planar, pair.has_problem && pair.problem.has_prior != 0);
  if (pair.scale)
    extrinsic.scale = NamedScale{pair.scale->sensor, pair.scale->solution.scale, pair.scale->solution.stddev,
                                 pair.scale->verified && pair.scale->solution.certified};
  return extrinsic;
}

}  // namespace egocal::monitor
