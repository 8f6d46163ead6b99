// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "answer_text.hpp"
#include "panels.hpp"

namespace egocal::monitor {

namespace {

/// At the right edge of a card's first row: as much as there is room for behind x.
void draw_counts(const Pane& pane, const PairState& pair, Now now, int x, bool paused) {
  const calibration_t* answer = pair.answer();
  const std::string frames = count(answer             ? answer->pairs
                                   : pair.has_problem ? pair.problem.matched
                                                      : 0) +
                             " frames";
  const std::string mode = paused             ? "PAUSED  "
                           : pair.has_problem ? (pair.problem.mode == 1 ? "planar  " : "3-D  ")
                                              : "";
  const std::string left_out =
      pair.has_problem && pair.problem.left_out > 0 ? "  " + count(pair.problem.left_out) + " outliers" : "";
  const std::string rejected =
      pair.has_problem && pair.problem.rejected > 0 ? "  " + count(pair.problem.rejected) + " rejected" : "";
  const std::string old =
      answer ? "  " + pad_left(age(seconds(pair.counted_solver()->at.mono_us, now.mono_us)), 5) : "";
  const std::string* parts[] = {&mode, &frames, &left_out, &rejected, &old};
  for (const unsigned chosen : {0b11111u, 0b10111u, 0b10011u, 0b10010u, 0b00010u, 0b10000u}) {
    std::string text;
    for (std::size_t i = 0; i < std::size(parts); ++i)
      if (chosen >> i & 1u) text += *parts[i];
    if (x + width_of(text) + 1 > pane.width()) continue;
    pane.text(pane.width() - width_of(text) - 1, 0, text,
              pair.silent || paused ? Style::warning : Style::dim);
    break;
  }
}

/// The proof and what it took, as many as fit, the most important first.
void draw_proof(const Pane& pane, int y, const PairState& pair, const calibration_t& answer, bool with_error,
                Charset charset) {
  const Label proof = proof_of(answer);
  int x = pane.text(4, y, proof.text, proof.style);
  const auto item = [&](const std::string& what, const std::string& value, Style value_style) {
    const int w = width_of(what) + (value.empty() ? 0 : 1 + width_of(value));
    if (x + 2 + w > pane.width()) return;
    x = pane.text(x + 2, y, what, value.empty() ? value_style : Style::dim);
    if (!value.empty()) x = pane.text(x + 1, y, value, value_style);
  };
  item("by", clean(answer.solver, 16) + " (" + clean(answer.method, 8) + ")",
       solver_style(pair.counted_solver()->role));
  item("gap", compact(answer.scaled_gap, charset) + " of 1",
       answer.scaled_gap <= 1 ? Style::normal : Style::warning);
  if (with_error)
    item(pair.shown.reference == ReferenceKind::truth ? "error" : "off nominal",
         centimetres(pair.shown.error_translation, charset) + " " +
             degrees(pair.shown.error_rotation, charset),
         Style::strong);
  const std::string missing = missing_directions(pair, answer);
  if (!missing.empty()) item("not shown: " + missing, "", Style::warning);
  if (pair.scale)
    item("scale", scale_text(*pair.scale, charset).text, scale_text(*pair.scale, charset).style);
  item("solve", solve_time(answer, charset), Style::normal);
  item("verify", verify_time(answer, charset), Style::normal);
  item("end to end", latency(answer, charset), Style::normal);
}

void draw_transform(const Pane& pane, int y, const PairState& pair, const calibration_t& answer,
                    Charset charset) {
  const Symbols& s = symbols(charset);
  const std::array<double, 6> values = components(pair.shown.T_a_b);
  for (int row = 0; row < 2; ++row) {
    pane.text(4, y + row, row == 0 ? "translation" : "rotation", Style::dim);
    int x = 17;
    for (int i = 3 * row; i < 3 * row + 3; ++i) {
      pane.text(x, y + row, pad_left(direction_names[i], 5), Style::dim);
      const auto d = static_cast<std::size_t>(i);
      const bool known = shown_by_motion(answer, i) || from_ground(pair, i);
      pane.text(x + 5, y + row, pad_left(number(values[d] * scale_of(i), 2, charset), 8),
                known ? Style::strong : Style::bad);
      pane.text(x + 14, y + row, pad_right(spread(pair, answer, i, 2, charset), 6),
                known ? Style::dim : Style::bad);
      x += 20;
    }
    pane.text(x, y + row, row == 0 ? "cm" : s.degree, Style::dim);
  }
}

/// At the right edge of the transform's rows.
void draw_error(const Pane& pane, int y, const PairState& pair, Charset charset) {
  const char* label = pair.shown.reference == ReferenceKind::truth ? "error" : "off nominal";
  for (int row = 0; row < 2; ++row) {
    const std::string value = row == 0 ? centimetres(pair.shown.error_translation, charset)
                                       : degrees(pair.shown.error_rotation, charset);
    const int start = pane.width() - 1 - width_of(value);
    pane.text(start - 1 - width_of(label), y + row, label, Style::dim);
    pane.text(start, y + row, value, Style::strong);
  }
}

}  // namespace

void draw_pair_card(const Pane& pane, const PairState& pair, Now now, bool selected, bool paused,
                    Charset charset) {
  if (selected) pane.text(0, 0, symbols(charset).cursor, Style::key);
  int x = pane.text(2, 0, pair_title(pair, charset), selected ? Style::title : Style::strong);
  const Label verdict = verdict_of(pair, charset);
  x = pane.text(std::max(x + 2, 27), 0, verdict.text, verdict.style) + 1;
  draw_counts(pane, pair, now, x, paused);
  const calibration_t* answer = pair.answer();
  if (!answer) {
    const std::string text =
        pair.scale && !pair.has_problem ? "scale " + scale_text(*pair.scale, charset).text
        : pair.has_problem
            ? "motions arrive (" + count(pair.problem.matched) + " so far), no solver has answered yet"
            : "no motions yet: is the odometry of both sensors coming in, and pairing running?";
    pane.text(4, 1, text, Style::dim);
    return;
  }
  if (!pair.shown.valid) {
    pane.text(4, 1, "the answer is no transform: values that are not finite", Style::bad);
    return;
  }
  // the advice has a row of its own where there are five
  int y = 1;
  if (pane.height() >= 5) {
    const Label advice = advice_of(pair);
    pane.text(4, y++,
              advice.text.empty() ? "no verdict yet: is egocal-diagnosis running?"
                                  : clean(advice.text, static_cast<std::size_t>(pane.width() - 5)),
              advice.style);
  }
  const bool has_reference = pair.shown.reference != ReferenceKind::none;
  const bool wide = pane.width() >= 99;
  draw_proof(pane, y, pair, *answer, has_reference && !wide, charset);
  draw_transform(pane, y + 1, pair, *answer, charset);
  if (has_reference && wide) draw_error(pane, y + 1, pair, charset);
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
        case PairColumn::proof:
          text = "optimal";
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
        const Label verdict = verdict_of(pair, charset);
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
        case PairColumn::proof:
          left(answer->status == 0 ? "proven" : answer->status == 1 ? "no" : "?", proof_of(*answer).style);
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

}  // namespace egocal::monitor
