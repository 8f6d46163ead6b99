// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "panels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "egocal/monitor/plot.hpp"

namespace egocal::monitor {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;
constexpr double kCentimetres = 100.0;
constexpr const char* kDirections[6] = {"x", "y", "z", "roll", "pitch", "yaw"};

double seconds(std::int64_t from_us, std::int64_t to_us) {
  return (static_cast<double>(to_us) - static_cast<double>(from_us)) * 1e-6;
}

double scale_of(int direction) {
  return direction < 3 ? kCentimetres : kDegrees;
}

// In planar mode the ground planes say what the motions cannot.
bool from_ground(const PairState& pair, int direction) {
  return pair.has_problem && pair.problem.mode == 1 && direction >= 2 && direction <= 4;
}

bool shown_by_motion(const calibration_t& answer, int direction) {
  return answer.observable[direction] != 0;
}

std::array<double, 6> components(const Pose& T) {
  const Eigen::Vector3d rpy = roll_pitch_yaw(T.rotation);
  return {T.translation.x(), T.translation.y(), T.translation.z(), rpy.x(), rpy.y(), rpy.z()};
}

std::string spread(const PairState& pair, const calibration_t& answer, int direction, int decimals,
                   Charset charset) {
  if (from_ground(pair, direction)) return "plane";
  return symbols(charset).plus_minus +
         number(answer.stddev[direction] * scale_of(direction), decimals, charset);
}

// "14.34 cm" or "0.262" degrees: as many decimals as the size deserves.
std::string centimetres(double metres, Charset charset) {
  const double value = metres * kCentimetres;
  return number(value, std::abs(value) < 100 ? 2 : 1, charset) + " cm";
}
std::string degrees(double radians, Charset charset) {
  const double value = radians * kDegrees;
  return number(value, std::abs(value) < 10 ? 3 : 1, charset) + (charset == Charset::unicode ? "°" : " deg");
}

double largest(const double* values) {
  return std::max({values[0], values[1], values[2]});
}

std::string missing_directions(const PairState& pair, const calibration_t& answer) {
  std::string text;
  for (int i = 0; i < 6; ++i)
    if (!shown_by_motion(answer, i) && !from_ground(pair, i))
      text += (text.empty() ? "" : " ") + std::string(kDirections[i]);
  return text;
}

std::string latency(const calibration_t& answer, Charset charset) {
  return answer.latency_us < 0 ? "-" : duration(static_cast<double>(answer.latency_us) * 1e-6, charset);
}
std::string solve_time(const calibration_t& answer, Charset charset) {
  return duration(static_cast<double>(answer.solve_ns) * 1e-9, charset);
}
std::string verify_time(const calibration_t& answer, Charset charset) {
  return duration(static_cast<double>(answer.verify_ns) * 1e-9, charset);
}

}  // namespace

Verdict verdict_of(const PairState& pair, Charset charset) {
  const Symbols& s = symbols(charset);
  const calibration_t* answer = pair.answer();
  if (!answer) return {pair.has_problem ? "solving" : "waiting", Style::dim};
  if (!pair.shown.valid) return {std::string(s.no) + " unusable", Style::bad};
  if (answer->status == 0) return {std::string(s.yes) + " certified", Style::good};
  if (answer->status == 1) return {std::string(s.no) + " not best", Style::bad};
  return {"? undecided", Style::warning};
}

void draw_title(const Pane& pane, const std::string& title, Charset charset) {
  const char* line = symbols(charset).line;
  pane.text(0, 0, line, Style::dim);
  int x = pane.text(2, 0, title, Style::title) + 1;
  while (x < pane.width()) x = pane.text(x, 0, line, Style::dim);
}

std::string pair_title(const PairState& pair, Charset charset, std::size_t max) {
  return clean(pair.a, max) + " " + symbols(charset).arrow + " " + clean(pair.b, max);
}

std::string short_solver(const std::string& name, std::size_t max) {
  const std::string prefix = "egocal-";
  return clean(name.rfind(prefix, 0) == 0 && name.size() > prefix.size() ? name.substr(prefix.size()) : name,
               max);
}

Style solver_style(Role role) {
  return role == Role::global ? Style::global : Style::fast;
}

void draw_pair_card(const Pane& pane, const PairState& pair, Now now, bool selected, Charset charset) {
  const Symbols& s = symbols(charset);
  const int right = pane.width();
  if (selected) pane.text(0, 0, s.cursor, Style::key);
  int x = pane.text(2, 0, pair_title(pair, charset), selected ? Style::title : Style::strong);
  const Verdict verdict = verdict_of(pair, charset);
  x = std::max(x + 2, 27);
  x = pane.text(x, 0, verdict.text, verdict.style) + 1;
  const calibration_t* answer = pair.answer();
  if (answer) {
    const SolverTrack& solver = *pair.counted_solver();
    x = pane.text(x, 0, "by ", Style::dim);
    x = pane.text(x, 0, clean(answer->solver, 16) + " (" + clean(answer->method, 8) + ")",
                  solver_style(solver.role)) +
        2;
  }
  std::string counted;
  if (pair.has_problem) counted += (pair.problem.mode == 1 ? "planar  " : "3-D  ");
  counted += count(answer ? answer->pairs : pair.has_problem ? pair.problem.matched : 0) + " frames";
  if (answer) {
    const double old = seconds(pair.counted_solver()->at.mono_us, now.mono_us);
    counted += "  " + pad_left(age(old), 5);
  }
  if (x + width_of(counted) + 1 <= right)
    pane.text(right - width_of(counted) - 1, 0, counted, pair.silent ? Style::warning : Style::dim);
  if (!answer) {
    const std::string text =
        pair.has_problem
            ? "motions arrive (" + count(pair.problem.matched) + " so far), no solver has answered yet"
            : "no motions yet: is the odometry of both sensors coming in, and pairing running?";
    pane.text(4, 1, text, Style::dim);
    return;
  }
  if (!pair.shown.valid) {
    pane.text(4, 1, "the answer is no transform: values that are not finite", Style::bad);
    return;
  }

  const std::array<double, 6> values = components(pair.shown.T_a_b);
  for (int row = 0; row < 2; ++row) {
    x = pane.text(4, 1 + row, row == 0 ? "translation" : "rotation", Style::dim);
    x = 17;
    for (int i = 3 * row; i < 3 * row + 3; ++i) {
      pane.text(x, 1 + row, pad_left(kDirections[i], 5), Style::dim);
      const auto d = static_cast<std::size_t>(i);
      const bool known = shown_by_motion(*answer, i) || from_ground(pair, i);
      pane.text(x + 5, 1 + row, pad_left(number(values[d] * scale_of(i), 2, charset), 8),
                known ? Style::strong : Style::bad);
      pane.text(x + 14, 1 + row, pad_right(spread(pair, *answer, i, 2, charset), 6),
                known ? Style::dim : Style::bad);
      x += 20;
    }
    x = pane.text(x, 1 + row, row == 0 ? "cm" : s.degree, Style::dim);
  }
  const bool has_reference = pair.shown.reference != ReferenceKind::none;
  if (has_reference && right >= 99) {
    const char* label = pair.shown.reference == ReferenceKind::truth ? "error" : "off nominal";
    for (int row = 0; row < 2; ++row) {
      const std::string value = row == 0 ? centimetres(pair.shown.error_translation, charset)
                                         : degrees(pair.shown.error_rotation, charset);
      const int start = right - 1 - width_of(value);
      pane.text(start - 1 - width_of(label), 1 + row, label, Style::dim);
      pane.text(start, 1 + row, value, Style::strong);
    }
  }
  x = pane.text(4, 3, "gap", Style::dim);
  x = pane.text(17, 3, compact(answer->scaled_gap, charset),
                answer->scaled_gap <= 1 ? Style::normal : Style::warning);
  x = pane.text(x, 3, " of 1", Style::dim);
  const auto timed = [&](const char* what, const std::string& value) {
    x = pane.text(x + 3, 3, what, Style::dim);
    x = pane.text(x + 1, 3, value);
  };
  timed("solve", solve_time(*answer, charset));
  timed("verify", verify_time(*answer, charset));
  timed("end to end", latency(*answer, charset));
  const std::string missing = missing_directions(pair, *answer);
  if (!missing.empty()) {
    pane.text(x + 3, 3, "not shown: " + missing, Style::warning);
  } else if (has_reference && right < 99) {
    pane.text(x + 3, 3,
              (pair.shown.reference == ReferenceKind::truth ? "error " : "off ") +
                  centimetres(pair.shown.error_translation, charset) + " " +
                  degrees(pair.shown.error_rotation, charset));
  }
}

void draw_pair_table(const Pane& pane, const Model& model, int selected, bool header, Charset charset) {
  const Symbols& s = symbols(charset);
  const std::vector<PlacedColumn> columns = layout_pair_table(pane.width());
  const auto& pairs = model.pairs();
  bool any_spread = false, any_nominal = false;
  for (const PairState& pair : pairs) {
    any_spread = any_spread || (pair.shown.valid && pair.shown.reference == ReferenceKind::none);
    any_nominal = any_nominal || pair.shown.reference == ReferenceKind::nominal;
  }
  const int top = header && pane.height() >= 2 ? 1 : 0;
  if (top) {
    for (const PlacedColumn& c : columns) {
      const char* text = "";
      bool right_aligned = true;
      switch (c.column) {
        case PairColumn::name:
          text = "pair";
          right_aligned = false;
          break;
        case PairColumn::verdict:
          text = "verdict";
          right_aligned = false;
          break;
        case PairColumn::error_translation:
          text = any_spread ? "spread" : any_nominal ? "off" : "error";
          break;
        case PairColumn::error_rotation:
          text = any_spread ? "spread" : any_nominal ? "nominal" : "error";
          break;
        case PairColumn::frames:
          text = "frames";
          break;
        case PairColumn::solver:
          text = "by";
          right_aligned = false;
          break;
        case PairColumn::translation:
          text = "x y z [cm]";
          right_aligned = false;
          break;
        case PairColumn::rotation:
          text = charset == Charset::unicode ? "roll pitch yaw [°]" : "roll pitch yaw [deg]";
          right_aligned = false;
          break;
        case PairColumn::gap:
          text = "gap of 1";
          break;
        case PairColumn::age:
          text = "age";
          break;
        case PairColumn::solve:
          text = "solve";
          break;
        case PairColumn::verify:
          text = "verify";
          break;
        case PairColumn::latency:
          text = "total";
          break;
      }
      pane.text(c.x, 0, right_aligned ? pad_left(text, c.width) : pad_right(text, c.width), Style::dim);
    }
  }
  if (pairs.empty()) {
    pane.text(1, top, "no pair yet: waiting for messages", Style::dim);
    return;
  }
  const int rows = pane.height() - top;
  const int first = std::clamp(selected - rows / 2, 0, std::max(0, static_cast<int>(pairs.size()) - rows));
  for (int row = 0; row < rows && first + row < static_cast<int>(pairs.size()); ++row) {
    const int index = first + row, y = top + row;
    const PairState& pair = pairs[static_cast<std::size_t>(index)];
    const calibration_t* answer = pair.answer();
    if (index == selected && pane.width() >= 20) pane.text(0, y, s.cursor, Style::key);
    for (const PlacedColumn& c : columns) {
      const auto left = [&](const std::string& text, Style style) {
        pane.text(c.x, y, pad_right(text, c.width), style);
      };
      const auto right = [&](const std::string& text, Style style) {
        pane.text(c.x, y, pad_left(text, c.width), style);
      };
      if (c.column == PairColumn::name) {
        left(pair_title(pair, charset), index == selected ? Style::title : Style::normal);
        continue;
      }
      if (c.column == PairColumn::verdict) {
        const Verdict verdict = verdict_of(pair, charset);
        left(verdict.text, verdict.style);
        continue;
      }
      if (c.column == PairColumn::frames) {
        right(count(answer ? answer->pairs : pair.has_problem ? pair.problem.matched : 0), Style::normal);
        continue;
      }
      if (!answer) continue;
      const bool has_reference = pair.shown.reference != ReferenceKind::none;
      const auto vector = [&](int from) {
        std::string text;
        const std::array<double, 6> values = components(pair.shown.T_a_b);
        for (int i = from; i < from + 3; ++i)
          text +=
              pad_left(number(values[static_cast<std::size_t>(i)] * scale_of(i), from == 0 ? 1 : 2, charset),
                       i == from ? 6 : 7);
        return text + " " + s.plus_minus +
               number(largest(answer->stddev + from) * scale_of(from), from == 0 ? 1 : 2, charset);
      };
      switch (c.column) {
        case PairColumn::error_translation:
          right(has_reference ? centimetres(pair.shown.error_translation, charset)
                              : s.plus_minus + centimetres(largest(answer->stddev), charset),
                Style::strong);
          break;
        case PairColumn::error_rotation:
          right(has_reference ? degrees(pair.shown.error_rotation, charset)
                              : s.plus_minus + degrees(largest(answer->stddev + 3), charset),
                Style::strong);
          break;
        case PairColumn::solver:
          left(short_solver(answer->solver), solver_style(pair.counted_solver()->role));
          break;
        case PairColumn::translation:
          left(pair.shown.valid ? vector(0) : "-", Style::normal);
          break;
        case PairColumn::rotation:
          left(pair.shown.valid ? vector(3) : "-", Style::normal);
          break;
        case PairColumn::gap:
          right(compact(answer->scaled_gap, charset),
                answer->scaled_gap <= 1 ? Style::normal : Style::warning);
          break;
        case PairColumn::age:
          right(age(seconds(pair.counted_solver()->at.mono_us, model.now().mono_us)),
                pair.silent ? Style::warning : Style::dim);
          break;
        case PairColumn::solve:
          right(solve_time(*answer, charset), Style::normal);
          break;
        case PairColumn::verify:
          right(verify_time(*answer, charset), Style::normal);
          break;
        case PairColumn::latency:
          right(latency(*answer, charset), Style::normal);
          break;
        default:
          break;
      }
    }
  }
}

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
  // who is gone comes first: that is what must be seen when there is no room for all
  std::vector<const ProcessState*> order;
  for (const bool alive : {false, true})
    for (const ProcessState& process : processes)
      if (process.alive == alive) order.push_back(&process);
  const int hidden = static_cast<int>(order.size()) - (pane.height() - y);
  if (title && hidden > 0) {
    const std::string text = " and " + std::to_string(hidden) + " more ";
    pane.text(pane.width() - width_of(text) - 1, 0, text, Style::dim);
  }
  for (const ProcessState* process : order) {
    if (y >= pane.height()) break;
    const status_t& status = process->status;
    const bool ended = status.state == "ended";
    const Style style = process->alive ? (status.state == "running" ? Style::good : Style::warning)
                        : ended        ? Style::dim
                                       : Style::bad;
    int x = pane.text(2, y, process->alive ? s.alive : s.gone, style) + 1;
    x = pane.text(x, y, pad_right(clean(status.name, 16), 16)) + 1;
    x = pane.text(x, y,
                  pad_right(process->alive ? clean(status.state, 8)
                            : ended        ? "ended"
                                           : "GONE",
                            8),
                  style) +
        1;
    if (pane.width() >= 60) {
      const std::string in = process->rate_in < 0 ? "-" : compact(process->rate_in, charset) + "/s";
      const std::string out = process->rate_out < 0 ? "-" : compact(process->rate_out, charset) + "/s";
      x = pane.text(x, y, "in ", Style::dim);
      x = pane.text(x, y, pad_right(in, 7)) + 1;
      x = pane.text(x, y, "out ", Style::dim);
      x = pane.text(x, y, pad_right(out, 7)) + 1;
    }
    x = pane.text(x, y, "lost ", Style::dim);
    x = pane.text(x, y, pad_right(count(process->lost), 4), process->lost ? Style::warning : Style::normal) +
        1;
    x = pane.text(x, y, "rejected ", Style::dim);
    x = pane.text(x, y, pad_right(count(process->rejected), 5),
                  process->rejected ? Style::warning : Style::normal) +
        1;
    if (!status.last_error.empty()) {
      x = pane.text(x, y, clean(status.last_error, 120), Style::bad);
    } else if (pane.width() >= 84) {
      pane.text(x, y, "pid " + std::to_string(status.pid) + " on " + clean(status.host, 20), Style::dim);
    }
    ++y;
  }
}

void draw_events(const Pane& pane, const Model& model, int scroll, int utc_offset_s, Charset charset) {
  const auto& events = model.events();
  if (events.empty()) {
    pane.text(2, 0, "nothing has happened yet", Style::dim);
    return;
  }
  const int n = static_cast<int>(events.size());
  const int last = n - 1 - std::clamp(scroll, 0, std::max(0, n - pane.height()));
  const int first = std::max(0, last - pane.height() + 1);
  for (int i = first; i <= last; ++i) {
    const Event& event = events[static_cast<std::size_t>(i)];
    const Style style = event.severity == Severity::good      ? Style::good
                        : event.severity == Severity::warning ? Style::warning
                        : event.severity == Severity::bad     ? Style::bad
                                                              : Style::normal;
    int x = pane.text(2, i - first, clock_time(event.at.wall_us, utc_offset_s), Style::dim) + 2;
    std::string subject = event.subject;
    if (const auto at = subject.find(" -> "); at != std::string::npos && charset == Charset::unicode)
      subject.replace(at, 4, " → ");
    x = pane.text(x, i - first, pad_right(clean(subject, 40), pane.width() >= 90 ? 24 : 18), Style::strong) +
        1;
    x = pane.text(x, i - first, clean(event.text, 200), style);
    if (event.repeated > 1)
      pane.text(x + 1, i - first, "(" + std::to_string(event.repeated) + " times)", Style::dim);
  }
}

void draw_summary(const Pane& pane, const PairState& pair, Charset charset) {
  const Symbols& s = symbols(charset);
  const calibration_t* answer = pair.answer();
  const Verdict verdict = verdict_of(pair, charset);
  int x = pane.text(0, 0, verdict.text, verdict.style) + 1;
  if (answer)
    pane.text(x, 0, "by " + clean(answer->solver, 16) + "  gap " + compact(answer->scaled_gap, charset),
              Style::dim);
  if (!answer || !pair.shown.valid) return;
  const std::array<double, 6> values = components(pair.shown.T_a_b);
  for (int row = 0; row < 2; ++row) {
    std::string text = row == 0 ? "t" : "R";
    for (int i = 3 * row; i < 3 * row + 3; ++i)
      text +=
          pad_left(number(values[static_cast<std::size_t>(i)] * scale_of(i), row == 0 ? 1 : 2, charset), 8);
    text += " " + std::string(s.plus_minus) +
            number(largest(answer->stddev + 3 * row) * scale_of(3 * row), row == 0 ? 1 : 2, charset);
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
    pane.text(0, 3, clean(answer->hint, 100), Style::warning);
  }
}

void draw_observability(const Pane& pane, const PairState& pair, Charset charset) {
  const Symbols& s = symbols(charset);
  draw_title(pane, "Observability", charset);
  const calibration_t* answer = pair.answer();
  if (!answer) {
    pane.text(2, 1, "no answer yet", Style::dim);
    return;
  }
  constexpr int kLabel = 8, kNumber = 11;
  const int length = std::max(4, pane.width() - kLabel - kNumber);
  for (int i = 0; i < 6; ++i) {
    const int y = 1 + i;
    pane.text(2, y, kDirections[i], Style::normal);
    const bool ground = from_ground(pair, i);
    const bool known = shown_by_motion(*answer, i);
    // from a metre (10 degrees) of doubt, an empty bar, to a millimetre (a hundredth of a degree), a full one
    const double doubt = answer->stddev[i] * (i < 3 ? 1.0 : kDegrees / 10.0);
    double filled =
        known && doubt >= 0 ? std::clamp(-std::log10(std::max(doubt, 1e-9)) / 3.0, 0.0, 1.0) : 0.0;
    if (ground) filled = 0;
    const Style style = ground         ? Style::dim
                        : !known       ? Style::bad
                        : filled < 0.4 ? Style::warning
                                       : Style::good;
    const int full = static_cast<int>(std::lround(filled * length));
    for (int k = 0; k < length; ++k)
      pane.text(kLabel + k, y, k < full ? s.bar_full : s.bar_empty, k < full ? style : Style::dim);
    const std::string text = ground   ? "plane"
                             : !known ? "not shown"
                                      : s.plus_minus + (i < 3 ? centimetres(answer->stddev[i], charset)
                                                              : degrees(answer->stddev[i], charset));
    pane.text(kLabel + length + 1, y, pad_left(text, kNumber - 2), known || ground ? Style::dim : Style::bad);
  }
  pane.text(2, 7, answer->hint.empty() ? "the motions show everything" : clean(answer->hint, 120),
            answer->hint.empty() ? Style::dim : Style::warning);
}

void draw_solvers(const Pane& pane, const PairState& pair, Now now, Charset charset) {
  const Symbols& s = symbols(charset);
  draw_title(pane, "Solvers", charset);
  if (pair.solvers.empty()) {
    pane.text(2, 1, "no answer yet", Style::dim);
    return;
  }
  constexpr int kLabel = 11;
  const int columns =
      std::min<int>({static_cast<int>(pair.solvers.size()), std::max(1, (pane.width() - kLabel) / 12), 3});
  const int w = std::min(20, (pane.width() - kLabel) / columns);
  // the one that counts first, then the freshest
  std::vector<const SolverTrack*> order;
  for (const SolverTrack& solver : pair.solvers) order.push_back(&solver);
  std::sort(order.begin(), order.end(),
            [](const SolverTrack* x, const SolverTrack* y) { return x->name < y->name; });
  if (static_cast<int>(order.size()) > columns)
    std::sort(order.begin(), order.end(),
              [](const SolverTrack* x, const SolverTrack* y) { return x->at.mono_us > y->at.mono_us; });
  constexpr const char* kRows[] = {"",     "method", "verdict", "gap",        "error t", "error R",
                                   "cost", "solve",  "verify",  "end to end", "frames",  "age"};
  for (int y = 1; y < static_cast<int>(std::size(kRows)); ++y) {
    const bool spread_row = pair.shown.reference == ReferenceKind::none && (y == 4 || y == 5);
    pane.text(2, 1 + y, spread_row ? (y == 4 ? "spread t" : "spread R") : kRows[y], Style::dim);
  }
  for (int c = 0; c < columns; ++c) {
    const SolverTrack& solver = *order[static_cast<std::size_t>(c)];
    const calibration_t& answer = solver.answer;
    const Shown own = shown_of(pair, answer);
    const int x = kLabel + 1 + c * w;
    const Pane column = pane.part({x, 0, w - 1, pane.height()});
    column.text(
        0, 1,
        (&solver == pair.counted_solver() ? std::string(s.cursor) + " " : "  ") + short_solver(solver.name),
        solver_style(solver.role));
    const bool certified = answer.status == 0;
    const bool referenced = own.reference != ReferenceKind::none;
    const auto value = [&](int row, const std::string& text, Style style = Style::normal) {
      column.text(2, 1 + row, text, style);
    };
    value(1, clean(answer.method, 9));
    value(2,
          certified            ? "certified"
          : answer.status == 1 ? "not best"
                               : "undecided",
          certified            ? Style::good
          : answer.status == 1 ? Style::bad
                               : Style::warning);
    value(3, compact(answer.scaled_gap, charset));
    value(4, centimetres(referenced ? own.error_translation : largest(answer.stddev), charset));
    value(5, degrees(referenced ? own.error_rotation : largest(answer.stddev + 3), charset));
    value(6, compact(answer.cost, charset));
    value(7, solve_time(answer, charset));
    value(8, verify_time(answer, charset));
    value(9, latency(answer, charset));
    value(10, count(answer.pairs));
    value(11, age(seconds(solver.at.mono_us, now.mono_us)), solver.silent ? Style::bad : Style::dim);
  }
}

void draw_direction(const Pane& pane, const PairState& pair, bool inverted, bool matrix, Charset charset) {
  const std::string from = clean(inverted ? pair.b : pair.a, 16), to = clean(inverted ? pair.a : pair.b, 16);
  draw_title(pane, "pose of " + to + " in " + from, charset);
  const calibration_t* answer = pair.answer();
  if (!answer || !pair.shown.valid) {
    pane.text(2, 1, "no answer yet", Style::dim);
    return;
  }
  const Pose T = inverted ? inverse(pair.shown.T_a_b) : pair.shown.T_a_b;
  const int w = pane.width();
  const int cell = w >= 48 ? 10 : 8, start = 8;
  const auto row = [&](int y, const char* label, const std::vector<std::string>& values, const char* unit) {
    pane.text(1, y, label, Style::dim);
    int x = start;
    for (const std::string& value : values) {
      pane.text(x, y, pad_left(value, cell));
      x += cell;
    }
    pane.text(x + 1, y, unit, Style::dim);
  };
  const Eigen::Vector3d t = T.translation, rpy = roll_pitch_yaw(T.rotation);
  const Eigen::Quaterniond& q = T.rotation;
  const int fine = cell - 4;  // decimals of what lies between -1 and 1
  row(1, "x y z",
      {number(t.x() * kCentimetres, 2, charset), number(t.y() * kCentimetres, 2, charset),
       number(t.z() * kCentimetres, 2, charset)},
      "cm");
  row(2, "q wxyz",
      {number(q.w(), fine, charset), number(q.x(), fine, charset), number(q.y(), fine, charset),
       number(q.z(), fine, charset)},
      "");
  row(3, "r p y",
      {number(rpy.x() * kDegrees, 3, charset), number(rpy.y() * kDegrees, 3, charset),
       number(rpy.z() * kDegrees, 3, charset)},
      symbols(charset).degree);
  if (!matrix) return;
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  for (int i = 0; i < 3; ++i)
    row(4 + i, i == 0 ? "R | t" : "",
        {number(R(i, 0), fine, charset), number(R(i, 1), fine, charset), number(R(i, 2), fine, charset),
         number(t(i), fine, charset)},
        i == 0 ? "m" : "");
}

void draw_curve(const Pane& pane, const PairState& pair, int curve, const ViewState& view) {
  const bool unicode = view.charset == Charset::unicode;
  Plot plot;
  plot.curve = static_cast<Curve>(curve);
  plot.logarithmic = view.logarithmic;
  const char* kind = pair.shown.reference == ReferenceKind::truth     ? "error"
                     : pair.shown.reference == ReferenceKind::nominal ? "off nominal"
                                                                      : "spread";
  switch (plot.curve) {
    case rotation_error:
      plot.title = std::string("rotation ") + kind + (unicode ? " [°]" : " [deg]");
      plot.scale = kDegrees;
      break;
    case translation_error:
      plot.title = std::string("translation ") + kind + " [cm]";
      plot.scale = kCentimetres;
      break;
    case scaled_gap:
      plot.title = "scaled duality gap (limit 1)";
      plot.threshold = 1.0;
      break;
    default:
      plot.title = std::string("execution time [") + symbols(view.charset).micro + "s]";
      plot.scale = 1e6;
      break;
  }
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const SolverTrack& solver : pair.solvers) {
    if (solver.history.empty()) continue;
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
  // the fast solver is what remains: its curve is drawn last, on top
  std::stable_sort(plot.series.begin(), plot.series.end(), [](const auto& x, const auto& y) {
    return x.style == Style::global && y.style != Style::global;
  });
  plot.mark = pair.only_fast_since;
  draw_plot(pane, plot, view.charset);
}

}  // namespace egocal::monitor
