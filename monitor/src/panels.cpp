// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "panels.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "answer_text.hpp"
#include "egocal/bus/process.hpp"
#include "event_list.hpp"

namespace egocal::monitor {

void draw_title(const Pane& pane, const std::string& title, Charset charset) {
  const char* line = symbols(charset).line;
  pane.text(0, 0, line, Style::dim);
  int x = pane.text(2, 0, title, Style::title) + 1;
  while (x < pane.width()) x = pane.text(x, 0, line, Style::dim);
}

namespace {

// columns of the screen
constexpr int cells_of_error = 30;  // of a process that begin to say what is wrong
constexpr int width_with_rates = 60, width_with_rates_and_error = 78 + cells_of_error;

/// Padded to a width, and wider rather than cut: a number without its last digit is another one.
std::string padded_number(const std::string& text, int width) {
  return pad_right(text, std::max(width, width_of(text)));
}

/// The order in which processes are listed when there is no room for all: those that are gone first, monitors
/// of other users last.
std::vector<const ProcessState*> in_order(const std::vector<ProcessState>& processes) {
  std::vector<const ProcessState*> order;
  for (const ProcessState& process : processes) order.push_back(&process);
  const auto rank = [](const ProcessState* process) {
    return process->status.role == bus::role_name(Role::monitor) ? 2 : process->alive ? 1 : 0;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](const auto* x, const auto* y) { return rank(x) < rank(y); });
  return order;
}

}  // namespace

void draw_processes(const Pane& pane, const Model& model, bool title, Charset charset) {
  const Symbols& s = symbols(charset);
  int y = 0;
  const auto& processes = model.processes();
  if (title) {
    draw_title(pane, "Processes", charset);
    ++y;
  }
  if (processes.empty()) {
    pane.text(2, y, "no heartbeat yet", Style::dim);
    return;
  }
  const std::vector<const ProcessState*> order = in_order(processes);
  const int hidden = static_cast<int>(order.size()) - (pane.height() - y);
  if (title && hidden > 0) {
    const std::string text = " and " + std::to_string(hidden) + " more ";
    pane.text(pane.width() - width_of(text) - 1, 0, text, Style::dim);
  }
  // in all rows or in none, so that the columns stay one below the other
  const bool any_error = std::any_of(order.begin(), order.end(), [](const ProcessState* process) {
    return !process->status.last_error.empty();
  });
  const bool rates = pane.width() >= (any_error ? width_with_rates_and_error : width_with_rates);
  for (const ProcessState* process : order) {
    if (y >= pane.height()) break;
    const status_t& status = process->status;
    const bool ended = process->state == bus::State::ended;
    const bool healthy = (process->state == bus::State::running || process->state == bus::State::standby) &&
                         !process->computes;
    const Style style = !process->known  ? Style::dim
                        : process->alive ? (healthy ? Style::good : Style::warning)
                        : ended          ? Style::dim
                                         : Style::bad;
    int x = pane.text(2, y, !process->known ? "?" : process->alive ? s.alive : s.gone, style) + 1;
    x = pane.text(x, y, pad_right(clean(status.name, 16), 16)) + 1;
    x = pane.text(x, y,
                  pad_right(ended               ? "ended"
                            : !process->known   ? "unknown"
                            : process->computes ? "computes"
                            : process->alive    ? clean(status.state, 8)
                                                : "GONE",
                            8),
                  style) +
        1;
    if (rates) {
      const auto rate = [&](double value) {
        return value < 0 ? "-" : number(value, value > 0 && value < 9.95 ? 1 : 0, charset) + "/s";
      };
      const std::string in = rate(process->rate_in), out = rate(process->rate_out);
      x = pane.text(x, y, "in ", Style::dim);
      x = pane.text(x, y, pad_right(in, 7)) + 1;
      x = pane.text(x, y, "out ", Style::dim);
      x = pane.text(x, y, pad_right(out, 7)) + 1;
    }
    x = pane.text(x, y, "lost ", Style::dim);
    x = pane.text(x, y, padded_number(count(process->lost), 4),
                  process->lost ? Style::warning : Style::normal) +
        1;
    x = pane.text(x, y, "rejected ", Style::dim);
    x = pane.text(x, y, padded_number(count(process->rejected), 5),
                  process->rejected ? Style::warning : Style::normal) +
        1;
    const bool error = !status.last_error.empty();
    const std::string where = "pid " + std::to_string(status.pid) + " on " + clean(status.host, 20) + "  ";
    if (pane.width() - x >= width_of(where) + (error ? cells_of_error : 0))
      x = pane.text(x, y, where, Style::dim);
    const auto room = static_cast<std::size_t>(std::max(0, pane.width() - x));
    if (error && room > 0) pane.text(x, y, clean(without_folders(status.last_error, room), room), Style::bad);
    ++y;
  }
}

namespace {

// cells of an event
constexpr int left_edge = 2, clock_cells = 8;
constexpr int least_of_subject = 18, most_of_subject = 40;  // two names that are long
constexpr int event_goes_on = 6;  // before a row that goes on, where there are no columns
/// Of the text where time, subject and text have a column each: in fewer it would take more rows than below
/// time and subject.
constexpr int least_of_text = 40;

int cells_of_subject(int width) {
  return std::clamp(width / 4, least_of_subject, most_of_subject);
}

int column_of_text(int width) {
  return left_edge + clock_cells + 2 + cells_of_subject(width) + 1;
}

std::string subject_in(const Event& event, int cells, Charset charset) {
  const auto at = event.subject.find(" -> ");
  return clean(at == std::string::npos
                   ? event.subject
                   : pair_in(event.subject.substr(0, at), event.subject.substr(at + 4), cells, charset),
               most_of_subject);
}

std::string times_of(const Event& event) {
  return event.repeated > 1 ? " (" + std::to_string(event.repeated) + " times)" : std::string();
}

Style style_of(const Event& event) {
  switch (event.severity) {
    case Severity::good:
      return Style::good;
    case Severity::warning:
      return Style::warning;
    case Severity::bad:
      return Style::bad;
    case Severity::info:
      break;
  }
  return Style::normal;
}

/// A row of an event, as its text and where that begins; the first one with the event's time and subject.
struct EventRow {
  const Event* first_of = nullptr;
  std::string text;
  int x = left_edge;
  Style style = Style::normal;
};

std::vector<EventRow> rows_of(const Event& event, int width, Charset charset) {
  const int column = column_of_text(width);
  const bool columns = width - column >= least_of_text;
  std::string text = event.text + times_of(event);
  if (!columns)  // the time is drawn before it
    text = std::string(clock_cells + 1, ' ') + subject_in(event, most_of_subject, charset) + ": " + text;
  const int x = columns ? column : left_edge, room = std::max(1, width - x - 1);
  std::vector<EventRow> rows;
  for (std::string& row : wrapped(text, static_cast<std::size_t>(room), columns ? 0 : event_goes_on))
    rows.push_back({nullptr, std::move(row), x, style_of(event)});
  if (rows.empty()) rows.push_back({nullptr, "", x, Style::normal});
  rows.front().first_of = &event;
  return rows;
}

}  // namespace

int event_line_count(const Model& model, int width, Charset charset) {
  std::size_t rows = 0;
  for (const Event& event : model.events()) rows += rows_of(event, width, charset).size();
  return static_cast<int>(rows);
}

void draw_whole_events(const Pane& pane, const Model& model, int scroll, int utc_offset_s, Charset charset) {
  if (model.events().empty()) {
    pane.text(left_edge, 0, "nothing has happened yet", Style::dim);
    return;
  }
  // the last row first, as many as are looked at
  std::vector<EventRow> rows;
  const int wanted = std::max(0, scroll) + pane.height();
  for (auto event = model.events().rbegin();
       event != model.events().rend() && static_cast<int>(rows.size()) < wanted; ++event) {
    std::vector<EventRow> more = rows_of(*event, pane.width(), charset);
    rows.insert(rows.end(), std::make_move_iterator(more.rbegin()), std::make_move_iterator(more.rend()));
  }
  const int n = static_cast<int>(rows.size()), shown = std::min(n, pane.height());
  const int below = std::clamp(scroll, 0, n - shown);
  for (int y = 0; y < shown; ++y) {
    const EventRow& row = rows[static_cast<std::size_t>(below + shown - 1 - y)];
    pane.text(row.x, y, row.text, row.style);
    if (!row.first_of) continue;
    const int x = pane.text(left_edge, y, clock_time(row.first_of->at.wall_us, utc_offset_s), Style::dim) + 2;
    if (row.x > left_edge)
      pane.text(x, y, subject_in(*row.first_of, cells_of_subject(pane.width()), charset), Style::strong);
  }
}

void draw_events(const Pane& pane, const Model& model, int scroll, int utc_offset_s, Charset charset) {
  const auto& events = model.events();
  if (events.empty()) {
    pane.text(left_edge, 0, "nothing has happened yet", Style::dim);
    return;
  }
  const int n = static_cast<int>(events.size());
  const int last = n - 1 - std::clamp(scroll, 0, std::max(0, n - pane.height()));
  const int first = std::max(0, last - pane.height() + 1);
  for (int i = first; i <= last; ++i) {
    const Event& event = events[static_cast<std::size_t>(i)];
    int x = pane.text(left_edge, i - first, clock_time(event.at.wall_us, utc_offset_s), Style::dim) + 2;
    const int cells = cells_of_subject(pane.width());
    x = pane.text(x, i - first, pad_right(subject_in(event, cells, charset), cells), Style::strong) + 1;
    const std::string times = times_of(event);
    const int room = pane.width() - x - width_of(times);
    if (room < 1) continue;
    x = pane.text(x, i - first, clean(event.text, static_cast<std::size_t>(room)), style_of(event));
    pane.text(x, i - first, times, Style::dim);
  }
}

}  // namespace egocal::monitor
