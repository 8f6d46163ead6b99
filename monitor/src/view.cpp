// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/view.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "answer_text.hpp"
#include "dialog.hpp"
#include "egocal/bus/backing.hpp"
#include "egocal/monitor/layout.hpp"
#include "event_list.hpp"
#include "panels.hpp"
#include "selection.hpp"

namespace egocal::monitor {
namespace {

/// The items of the header from left to right, as many as fit before the clock.
class HeaderLine {
 public:
  HeaderLine(const Pane& pane, const ViewState& view, std::int64_t wall_us)
      : pane_(pane), view_(view), right_(clock_time(wall_us, view.utc_offset_s)) {
    if (view.frozen) right_ = std::string(view_paused) + "  " + right_;
    end_ = pane.width() - (pane.width() >= 40 || view.frozen ? width_of(right_) + 3 : 0);
  }

  int width() const { return pane_.width(); }
  bool has_room_for(int cells) const { return x_ + cells <= end_; }
  /// Draws an item. False: there is no room for it.
  bool item(const std::string& text, Style style, int gap = 0) {
    if (!has_room_for(width_of(text))) return false;
    must(text, style, gap);
    return true;
  }
  /// Draws an item also where the clock would have been.
  void must(const std::string& text, Style style, int gap = 0) { x_ = pane_.text(x_, 0, text, style) + gap; }
  /// Says before the clock that the network is away: nothing else in this line is current then.
  void say_away() {
    constexpr const char* no_network = "NO NETWORK";
    if (!view_.network_error.empty() && x_ + width_of(no_network) <= width()) must(no_network, Style::bad, 2);
  }
  /// Draws as much of the clock as there is room for. A paused view says so at any width: its clock does not
  /// go on.
  void draw_clock(const std::string& before = "") {
    const Style style = view_.frozen ? Style::warning : Style::dim;
    for (const std::string& text : {before + right_, right_})
      if (draw_right(text, style, x_)) return;
    if (view_.frozen && !draw_right(view_paused, style, x_))
      draw_right(std::string(" ") + view_paused, style, -1);
  }

 private:
  static constexpr const char* view_paused = "VIEW PAUSED";

  /// Draws a text at the end of the line. False: it would begin before after + 1.
  bool draw_right(const std::string& text, Style style, int after) {
    const int at = width() - width_of(text) - 1;
    if (at <= after) return false;
    pane_.text(at, 0, text, style);
    return true;
  }

  const Pane& pane_;
  const ViewState& view_;
  std::string right_;
  int x_ = 1, end_ = 0;
};

/// "lidar -> camera  good by global · 412 motions · 3 outliers · 3-D · offset 0.0 ms · many strides".
void draw_pair_header(HeaderLine& line, const PairState& pair, bool paused, Charset charset) {
  const Symbols& s = symbols(charset);
  line.must(pair_title(pair, charset, line.width() >= 60 ? 24 : 12), Style::title, 2);
  line.say_away();
  if (paused) line.item("PAUSED ", Style::warning);
  if (pair.ended && !paused) line.item("ENDED ", Style::dim);
  const Label verdict = verdict_of(pair, charset);
  line.item(verdict.text, verdict.style);
  const std::string between = std::string(" ") + s.dot + " ";
  if (const calibration_t* answer = pair.answer()) {
    const std::string solver = clean(answer->solver, 16), by = " by ";
    if (line.has_room_for(width_of(by) + width_of(solver))) {
      line.item(by, Style::dim);
      line.item(solver, solver_style(pair.counted_solver()->role));
    }
    line.item(between + count(answer->pairs) + " motions", Style::dim);
  }
  if (!pair.has_problem) return;
  const problem_t& problem = pair.problem;
  if (problem.left_out > 0) line.item(between + count(problem.left_out) + " outliers", Style::warning);
  if (problem.rejected > 0) line.item(between + count(problem.rejected) + " rejected", Style::dim);
  line.item(between + (problem.mode == 1 ? "planar" : "3-D"), Style::dim);
  std::string offset = number(problem.time_offset * 1e3, 1, charset);
  if (problem.time_offset_stddev >= 0)
    offset += " " + std::string(s.plus_minus) + number(problem.time_offset_stddev * 1e3, 1, charset);
  line.item(between + "offset " + offset + " ms", Style::dim);
  line.item(between + stride_text(problem), Style::dim);
}

/// "egocal  3 of 4 good  1 contradictory  4 proven optimal  1 gone": a pair that is so may be below the last
/// row.
void draw_overview_header(HeaderLine& line, const Model& model) {
  const auto pairs = static_cast<std::ptrdiff_t>(model.pairs().size());
  const auto number_of = [&](const auto& is_so) {
    return std::count_if(model.pairs().begin(), model.pairs().end(), is_so);
  };
  const auto good = number_of(is_good);
  const auto certified = number_of([](const PairState& p) { return p.answer() && p.answer()->status == 0; });
  const auto old = number_of([](const PairState& p) { return p.old > 0; });
  const auto paused = number_of([&](const PairState& p) { return pair_is_paused(model, p); });
  const auto contradictory = number_of(
      [](const PairState& p) { return p.verdict && p.verdict->diagnosis.verdict == Verdict::contradictory; });
  const auto gone =
      std::count_if(model.processes().begin(), model.processes().end(),
                    [](const ProcessState& p) { return !p.alive && p.state != bus::State::ended; });
  line.must("egocal", Style::title, 2);
  line.must(std::to_string(good) + " of " + std::to_string(pairs) + " good",
            good == pairs && good > 0 ? Style::good : Style::normal, 2);
  line.say_away();
  if (contradictory > 0) line.item(std::to_string(contradictory) + " contradictory", Style::bad, 2);
  if (old > 0) line.item(std::to_string(old) + " old", Style::warning, 2);
  if (line.width() >= 50)
    line.must(std::to_string(certified) + " proven optimal",
              certified == pairs && certified > 0 && old == 0 ? Style::good : Style::normal, 2);
  if (gone > 0) line.must(std::to_string(gone) + " gone", Style::bad, 2);
  if (paused > 0)
    line.must(paused == pairs ? "PAUSED" : std::to_string(paused) + " PAUSED", Style::warning, 2);
}

void draw_header(const Pane& pane, const Model& model, const ViewState& view) {
  if (pane.height() < 1) return;
  HeaderLine line(pane, view, model.now().wall_us);
  const PairState* const pair = selected_pair(model, view);
  if (view.screen == Screen::detail && pair) {
    draw_pair_header(line, *pair, pair_is_paused(model, *pair), view.charset);
    line.draw_clock();
  } else {
    draw_overview_header(line, model);
    line.draw_clock(pane.width() >= 70 ? clean(view.source, 40) + "  " : "");
  }
}

void draw_keys(const Pane& pane, const ViewState& view) {
  if (pane.height() < 1) return;
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
  if (!view.notice.empty()) x = pane.text(x, 0, clean(view.notice, 200), Style::warning) + 3;
  for (const Hint& hint : hints) {
    const int w = width_of(hint.key) + 1 + width_of(hint.does);
    if (x + w > pane.width()) break;
    x = pane.text(x, 0, hint.key, Style::key) + 1;
    x = pane.text(x, 0, hint.does, Style::dim) + 3;
  }
}

/// The number of lines about streams on the overview: none while no stream has a fault. All streams have a
/// screen of their own.
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
    draw_whole_events(list, model, view.scroll, view.utc_offset_s, view.charset);
    return;
  }
  draw_title(list, "Events", view.charset);
  draw_whole_events(list.part({0, 1, list.width(), list.height() - 1}), model, view.scroll, view.utc_offset_s,
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
  if (const std::optional<bus::Departure> moved = departure_of(pair)) {
    extrinsic.verdict.clear();
    extrinsic.reason = bus::in_words(*moved);
    extrinsic.usable = false;
  }
  // as on the screen: a verdict of the past is not stated as one of this answer
  if (pair.old > 0 || (pair.verdict && pair.verdict->old > 0)) {
    extrinsic.verdict.clear();
    extrinsic.reason = advice_of(pair).text;
  }
  if (pair.old > 0) extrinsic.usable = false;
  extrinsic.stddev = pair.shown.observability.stddev;
  bus::CheckedAnswer heard;
  for (std::size_t i = 0; i < 6; ++i) heard.answer.observability.observable[i] = answer->observable[i] != 0;
  if (pair.has_problem) heard.problem = bus::to_problem(pair.problem).value;
  extrinsic.backing =
      bus::backing_of(heard, answer->method, false, pair.verdict ? &pair.verdict->diagnosis : nullptr);
  if (pair.scale)
    extrinsic.scale = NamedScale{pair.scale->sensor, pair.scale->solution.scale, pair.scale->solution.stddev,
                                 pair.scale->verified && pair.scale->solution.certified};
  return extrinsic;
}

}  // namespace egocal::monitor
