// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/view.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "answer_text.hpp"
#include "dialog.hpp"
#include "egocal/monitor/layout.hpp"
#include "panels.hpp"

namespace egocal::monitor {
namespace {

constexpr std::array<double, 6> window_choices{10, 30, 60, 300, 1800, 7200};  // [s]

const PairState* selected_pair(const Model& model, const ViewState& view) {
  if (model.pairs().empty()) return nullptr;
  const int last = static_cast<int>(model.pairs().size()) - 1;
  return &model.pairs()[static_cast<std::size_t>(std::clamp(view.selected, 0, last))];
}

/// Measured time that the curves of a pair cover [s].
double session_length(const PairState* pair) {
  const calibration_t* answer = pair ? pair->answer() : nullptr;
  return answer ? 1e-6 * (static_cast<double>(answer->utime) - static_cast<double>(pair->session)) : 0;
}

/// step > 0: less of the session, from all of it through the windows that are shorter than it.
void zoom(ViewState& view, const Model& model, int step) {
  const double length = session_length(selected_pair(model, view));
  std::vector<double> windows;
  for (const double window : window_choices)
    if (window < length || window == window_choices.front() || window == view.window_s)
      windows.push_back(window);
  windows.push_back(0);  // all
  auto at = std::find(windows.begin(), windows.end(), view.window_s);
  if (step > 0 && at != windows.begin()) --at;
  if (step < 0 && at + 1 != windows.end()) ++at;
  view.window_s = *at;
  view.notice = view.window_s == 0 ? "the curves show the whole session"
                                   : "the curves show the last " + age(view.window_s);
}

Action about_pair(Action::Kind kind, const PairState& pair) {
  Action action;
  action.kind = kind;
  action.a = pair.a;
  action.b = pair.b;
  action.session = pair.session;
  return action;
}

Action press_in_dialog(ViewState& view, const Model& model, KeyPress key) {
  const Dialog dialog = view.dialog;
  view.dialog = Dialog::none;
  const PairState* pair = selected_pair(model, view);
  const char c = key.key == Key::character ? key.character : '\0';
  if (dialog == Dialog::help || !pair) return {};
  if (dialog == Dialog::export_format) {
    constexpr ExtrinsicFormat formats[] = {ExtrinsicFormat::yaml, ExtrinsicFormat::ros, ExtrinsicFormat::urdf,
                                           ExtrinsicFormat::kalibr};
    for (ExtrinsicFormat format : formats)
      if (c == to_string(format)[0]) {
        Action action = about_pair(Action::Kind::export_answer, *pair);
        action.format = format;
        return action;
      }
    view.notice = "nothing exported";
    return {};
  }
  if (c == 'y' || c == 'Y') {
    return about_pair(dialog == Dialog::reset   ? Action::Kind::reset
                      : dialog == Dialog::pause ? Action::Kind::pause
                                                : Action::Kind::resume,
                      *pair);
  }
  view.notice = "nothing done";
  return {};
}

void ask(ViewState& view, const Model& model, Dialog dialog) {
  if (!selected_pair(model, view)) {
    view.notice = "there is no pair yet";
  } else if (!view.live && dialog != Dialog::export_format) {
    view.notice = "this is a log: there is no process to command";
  } else {
    view.dialog = dialog;
  }
}

void draw_header(const Pane& pane, const Model& model, const ViewState& view) {
  if (pane.height() < 1) return;
  const Symbols& s = symbols(view.charset);
  const PairState* pair = selected_pair(model, view);
  int x = 1;
  std::string right = clock_time(model.now().wall_us, view.utc_offset_s);
  if (view.frozen) right = "VIEW PAUSED  " + right;
  // items from left to right as far as there is room before the clock
  const int end = pane.width() - (pane.width() >= 40 || view.frozen ? width_of(right) + 3 : 0);
  const auto item = [&](const std::string& text, Style style) {
    if (x + width_of(text) > end) return false;
    x = pane.text(x, 0, text, style);
    return true;
  };
  if (view.screen == Screen::detail && pair) {
    x = pane.text(x, 0, pair_title(*pair, view.charset, pane.width() >= 60 ? 24 : 12), Style::title) + 2;
    const bool paused = pair_is_paused(model, *pair);
    if (paused) item("PAUSED ", Style::warning);
    const Label verdict = verdict_of(*pair, view.charset);
    item(verdict.text, verdict.style);
    const std::string between = std::string(" ") + s.dot + " ";
    const calibration_t* answer = pair->answer();
    if (answer && item(" by ", Style::dim))
      item(clean(answer->solver, 16), solver_style(pair->counted_solver()->role));
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
      item(between + "stride " + std::to_string(problem.stride), Style::dim);
    }
  } else {
    x = pane.text(x, 0, "egocal", Style::title) + 2;
    std::size_t good = 0, certified = 0, gone = 0, paused = 0;
    for (const PairState& p : model.pairs()) paused += pair_is_paused(model, p);
    for (const PairState& p : model.pairs()) certified += p.answer() && p.answer()->status == 0;
    for (const PairState& p : model.pairs())
      good +=
          p.answer() && p.answer()->status == 0 && p.verdict && p.verdict->diagnosis.verdict == Verdict::good;
    for (const ProcessState& p : model.processes()) gone += !p.alive && p.state != bus::State::ended;
    x = pane.text(x, 0, std::to_string(good) + " of " + std::to_string(model.pairs().size()) + " good",
                  good == model.pairs().size() && good ? Style::good : Style::normal) +
        2;
    if (pane.width() >= 50)
      x = pane.text(x, 0, std::to_string(certified) + " proven optimal",
                    certified == model.pairs().size() && certified ? Style::good : Style::normal) +
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

// A title where there is room for one.
int event_rows(int height) {
  return height < 3 ? std::max(1, height) : height - 1;
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

Action press(ViewState& view, const Model& model, KeyPress key) {
  view.notice.clear();
  if (view.dialog != Dialog::none) return press_in_dialog(view, model, key);
  const int pairs = static_cast<int>(model.pairs().size());
  const int events = static_cast<int>(model.events().size());
  const auto select = [&](int index) { view.selected = pairs ? std::clamp(index, 0, pairs - 1) : 0; };
  const int page = event_rows(layout_events(80, view.height).list.h);
  const auto scroll = [&](int lines) {
    // the newest event is at the bottom, the first stream at the top
    if (view.screen == Screen::streams)
      view.scroll = std::clamp(view.scroll - lines, 0, std::max(0, stream_line_count(model) - page));
    else
      view.scroll = std::clamp(view.scroll + lines, 0, std::max(0, events - page));
  };
  const bool list = view.screen == Screen::events || view.screen == Screen::streams;
  switch (key.key) {
    case Key::up:
      list ? scroll(1) : select(view.selected - 1);
      return {};
    case Key::down:
      list ? scroll(-1) : select(view.selected + 1);
      return {};
    case Key::page_up:
      list ? scroll(page) : select(view.selected - 10);
      return {};
    case Key::page_down:
      list ? scroll(-page) : select(view.selected + 10);
      return {};
    case Key::home:
      list ? scroll(events) : select(0);
      return {};
    case Key::end:
      list ? scroll(-events) : select(pairs - 1);
      return {};
    case Key::enter:
    case Key::right:
      if (view.screen == Screen::overview) view.screen = Screen::detail;
      return {};
    case Key::escape:
    case Key::left:
      view.screen = Screen::overview;
      return {};
    case Key::tab:
      view.screen = view.screen == Screen::overview ? Screen::detail
                    : view.screen == Screen::detail ? Screen::events
                                                    : Screen::overview;
      return {};
    case Key::character:
      break;
  }
  switch (key.character) {
    case 'q':
    case 'Q': {
      Action action;
      action.kind = Action::Kind::quit;
      return action;
    }
    case '?':
    case 'h':
      view.dialog = Dialog::help;
      break;
    case 'k':
      list ? scroll(1) : select(view.selected - 1);
      break;
    case 'j':
      list ? scroll(-1) : select(view.selected + 1);
      break;
    case 'n':
      select(pairs ? (view.selected + 1) % pairs : 0);
      break;
    case 'N':
      select(pairs ? (view.selected + pairs - 1) % pairs : 0);
      break;
    case '1':
      view.screen = Screen::overview;
      break;
    case '2':
      view.screen = Screen::detail;
      break;
    case '3':
    case 'e':
      view.screen = Screen::events;
      view.scroll = 0;
      break;
    case '4':
    case 's':
      view.screen = Screen::streams;
      view.scroll = 0;
      break;
    case '+':
    case '=':
      zoom(view, model, 1);
      break;
    case '-':
      zoom(view, model, -1);
      break;
    case 'l':
      view.logarithmic = !view.logarithmic;
      view.notice = view.logarithmic ? "logarithmic axes" : "linear axes";
      break;
    case ' ':
      view.frozen = !view.frozen;
      break;
    case 'r':
      ask(view, model, Dialog::reset);
      break;
    case 'p':
      ask(view, model,
          (selected_pair(model, view) && pair_is_paused(model, *selected_pair(model, view))) ? Dialog::resume
                                                                                             : Dialog::pause);
      break;
    case 'x':
      ask(view, model, Dialog::export_format);
      break;
    default:
      break;
  }
  return {};
}

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
    extrinsic.usable = pair.verdict->diagnosis.verdict != Verdict::contradictory;
  }
  extrinsic.stddev.emplace();
  std::copy_n(answer->stddev, 6, extrinsic.stddev->begin());
  return extrinsic;
}

}  // namespace egocal::monitor
