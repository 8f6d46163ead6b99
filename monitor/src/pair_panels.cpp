// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "answer_text.hpp"
#include "number_cells.hpp"
#include "panels.hpp"

namespace egocal::monitor {

namespace {

/// Draws counts at the right edge of the first row of a card, as many as fit to the right of x.
void draw_counts(const Pane& pane, const PairState& pair, Now now, int x, bool paused) {
  const calibration_t* answer = pair.answer();
  const std::string motions = count(answer             ? answer->pairs
                                    : pair.has_problem ? pair.problem.matched
                                                       : 0) +
                              " motions";
  const std::string mode = paused                        ? "PAUSED  "
                           : pair.ended                  ? "ENDED  "
                           : session_has_no_motion(pair) ? "NO MOTION  "
                           : pairing_is_silent(pair)     ? "PAIRING IS SILENT  "
                           : pair.has_problem            ? (pair.problem.mode == 1 ? "planar  " : "3-D  ")
                                                         : "";
  const std::string left_out =
      pair.has_problem && pair.problem.left_out > 0 ? "  " + count(pair.problem.left_out) + " outliers" : "";
  const std::string rejected =
      pair.has_problem && pair.problem.rejected > 0 ? "  " + count(pair.problem.rejected) + " rejected" : "";
  const std::string old = answer ? "  " + pad_left(answer_age(pair, *pair.counted_solver(), now), 5) : "";
  const std::string* parts[] = {&mode, &motions, &left_out, &rejected, &old};
  for (const unsigned chosen : {0b11111u, 0b10111u, 0b10011u, 0b10010u, 0b00010u, 0b10000u}) {
    std::string text;
    for (std::size_t i = 0; i < std::size(parts); ++i)
      if (chosen >> i & 1u) text += *parts[i];
    if (x + width_of(text) + 1 > pane.width()) continue;
    pane.text(pane.width() - width_of(text) - 1, 0, text,
              !pair.ended && (pair.silent || paused) ? Style::warning : Style::dim);
    break;
  }
}

/// Draws the proof and its times, the most important first, as many as fit.
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
  const std::string missing = missing_directions(pair);
  if (!missing.empty()) item("not shown: " + missing, "", Style::warning);
  if (pair.scale)
    item("scale", scale_text(*pair.scale, charset).text, scale_text(*pair.scale, charset).style);
  item("solve", solve_time(answer, charset), Style::normal);
  item("verify", verify_time(answer, charset), Style::normal);
  item("end to end", latency(answer, charset), Style::normal);
}

void draw_transform(const Pane& pane, int y, const PairState& pair, Charset charset) {
  const Symbols& s = symbols(charset);
  const std::array<double, 6> values = components(pair.shown.T_a_b);
  for (int row = 0; row < 2; ++row) {
    pane.text(4, y + row, row == 0 ? "translation" : "rotation", Style::dim);
    int x = 17, end = x;
    for (int i = 3 * row; i < 3 * row + 3; ++i) {
      pane.text(x + 5 - width_of(direction_names[i]), y + row, direction_names[i], Style::dim);
      const auto d = static_cast<std::size_t>(i);
      const bool known = shown_by_motion(pair.shown, i) || from_ground(pair, i);
      pane.text(x + 5, y + row, in_cells(values[d] * scale_of(i), 2, 8, charset),
                known ? Style::strong : Style::bad);
      std::string spread_text = spread(pair, i, 2, charset);
      if (width_of(spread_text) > 6) spread_text = spread(pair, i, 1, charset);
      if (width_of(spread_text) > 7)
        spread_text = s.plus_minus + power_of_ten(pair.shown.observability.stddev[d] * scale_of(i));
      end = pane.text(x + 14, y + row, spread_text, known ? Style::dim : Style::bad);
      x += 20;
    }
    const std::string unit = row == 0 ? "cm" : s.degree;
    pane.text(std::max({x, end, std::min(end + 1, pane.width() - width_of(unit))}), y + row, unit,
              Style::dim);
  }
}

/// Draws the error at the right edge of the transform's rows.
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
    pane.text(4, 1,
              clean(unanswered_text(pair, charset), static_cast<std::size_t>(std::max(0, pane.width() - 5))),
              Style::dim);
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
  draw_transform(pane, y + 1, pair, charset);
  if (has_reference && wide) draw_error(pane, y + 1, pair, charset);
}

}  // namespace egocal::monitor
