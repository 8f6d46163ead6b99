// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The table of all pairs: one row a pair, its columns as layout_pair_table() places them.
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "answer_text.hpp"
#include "number_cells.hpp"
#include "panels.hpp"

namespace egocal::monitor {

namespace {

struct Cell {
  std::string text;
  Style style = Style::normal;
};

bool right_aligned(PairColumn column) {
  switch (column) {
    case PairColumn::name:
    case PairColumn::verdict:
    case PairColumn::proof:
    case PairColumn::solver:
    case PairColumn::translation:
    case PairColumn::rotation:
      return false;
    default:
      return true;
  }
}

/// What the two columns of errors show, by the references that the pairs have.
struct ErrorKind {
  bool spread = false, nominal = false;
};

ErrorKind error_kind(const std::vector<PairState>& pairs) {
  ErrorKind kind;
  for (const PairState& pair : pairs) {
    kind.spread = kind.spread || (pair.shown.valid && pair.shown.reference == ReferenceKind::none);
    kind.nominal = kind.nominal || pair.shown.reference == ReferenceKind::nominal;
  }
  return kind;
}

const char* heading_of(PairColumn column, ErrorKind error, Charset charset) {
  switch (column) {
    case PairColumn::name:
      return "pair";
    case PairColumn::verdict:
      return "verdict";
    case PairColumn::proof:
      return "optimal";
    case PairColumn::error_translation:
      return error.spread ? "spread t" : error.nominal ? "off" : "error t";
    case PairColumn::error_rotation:
      return error.spread ? "spread R" : error.nominal ? "nominal" : "error R";
    case PairColumn::motions:
      return "motions";
    case PairColumn::solver:
      return "by";
    case PairColumn::translation:
      return "x y z [cm]";
    case PairColumn::rotation:
      return charset == Charset::unicode ? "roll pitch yaw [°]" : "roll pitch yaw [deg]";
    case PairColumn::gap:
      return "gap of 1";
    case PairColumn::age:
      return "age";
    case PairColumn::solve:
      return "solve";
    case PairColumn::verify:
      return "verify";
    case PairColumn::latency:
      return "total";
  }
  return "";
}

/// Three components of the transform, from x or from roll on, with the largest of their standard deviations.
std::string three_components(const PairState& pair, int from, Charset charset) {
  if (!pair.shown.valid) return "-";
  const int decimals = from == 0 ? 1 : 2;
  const std::array<double, 6> values = components(pair.shown.T_a_b);
  std::string text;
  for (int i = from; i < from + 3; ++i)
    text += in_cells(values[static_cast<std::size_t>(i)] * scale_of(i), decimals, 7, charset);
  text.erase(0, 1);  // the blank before the first one
  return text + " " + symbols(charset).plus_minus +
         number(largest_stddev(pair.shown, static_cast<std::size_t>(from)) * scale_of(from), decimals,
                charset);
}

/// "0.287deg" where "0.287 deg" is too wide, and without the unit where that is: no part of a unit.
std::string angle_in(int cells, std::string text) {
  const std::size_t blank = text.find(' ');
  if (width_of(text) <= cells || blank == std::string::npos) return text;
  const std::string alone = text.substr(0, blank);
  text.erase(blank, 1);
  return width_of(text) <= cells ? text : alone;
}

/// The cell of a column that needs an answer.
Cell cell_of_answer(const PairState& pair, const calibration_t& answer, const PlacedColumn& placed, Now now,
                    Charset charset) {
  const PairColumn column = placed.column;
  const int width = placed.width;
  const Symbols& s = symbols(charset);
  const bool has_reference = pair.shown.reference != ReferenceKind::none;
  switch (column) {
    case PairColumn::error_translation: {
      const std::string before = has_reference ? "" : s.plus_minus;
      const double off = has_reference ? pair.shown.error_translation : largest_stddev(pair.shown, 0);
      return {distance_in(width, before + centimetres(off, charset), off, charset, before), Style::strong};
    }
    case PairColumn::error_rotation: {
      const double off = has_reference ? pair.shown.error_rotation : largest_stddev(pair.shown, 3);
      return {angle_in(width, (has_reference ? "" : s.plus_minus) + degrees(off, charset)), Style::strong};
    }
    case PairColumn::proof:
      return {answer.status == 0 ? "proven" : answer.status == 1 ? "no" : "?", proof_of(answer).style};
    case PairColumn::solver:
      return {short_solver(answer.solver), solver_style(pair.counted_solver()->role)};
    case PairColumn::translation:
      return {three_components(pair, 0, charset)};
    case PairColumn::rotation:
      return {three_components(pair, 3, charset)};
    case PairColumn::gap:
      return {compact(answer.scaled_gap, charset), answer.scaled_gap <= 1 ? Style::normal : Style::warning};
    case PairColumn::age:
      return {answer_age(pair, *pair.counted_solver(), now),
              pair.silent || pair.standing > 0 || pair.old > 0 ? Style::warning : Style::dim};
    case PairColumn::solve:
      return {solve_time(answer, charset)};
    case PairColumn::verify:
      return {verify_time(answer, charset)};
    case PairColumn::latency:
      return {latency(answer, charset)};
    default:
      return {};
  }
}

/// The cell of a column; empty: nothing is drawn there.
std::optional<Cell> cell_of(const PairState& pair, const PlacedColumn& placed, bool selected, Now now,
                            Charset charset) {
  const PairColumn column = placed.column;
  const calibration_t* answer = pair.answer();
  if (column == PairColumn::name)
    return Cell{pair_in(pair.a, pair.b, placed.width, charset), selected ? Style::title : Style::normal};
  if (column == PairColumn::verdict) {
    const Label verdict = verdict_of(pair, charset);
    return Cell{verdict.text, verdict.style};
  }
  if (column == PairColumn::motions)
    return Cell{count(answer ? answer->pairs : pair.has_problem ? pair.problem.matched : 0)};
  if (!answer) return std::nullopt;
  return cell_of_answer(pair, *answer, placed, now, charset);
}

void draw_cell(const Pane& pane, int y, const PlacedColumn& column, const Cell& cell) {
  pane.text(
      column.x, y,
      right_aligned(column.column) ? pad_left(cell.text, column.width) : pad_right(cell.text, column.width),
      cell.style);
}

}  // namespace

void draw_pair_table(const Pane& pane, const Model& model, int selected, bool header, Charset charset) {
  const std::vector<PlacedColumn> columns = layout_pair_table(pane.width());
  const auto& pairs = model.pairs();
  const int top = header && pane.height() >= 2 ? 1 : 0;
  const ErrorKind error = error_kind(pairs);
  if (top)
    for (const PlacedColumn& column : columns)
      draw_cell(pane, 0, column, {heading_of(column.column, error, charset), Style::dim});
  if (pairs.empty()) {
    pane.text(1, top, "no pair yet: waiting for messages", Style::dim);
    return;
  }
  const int rows = pane.height() - top;
  const int first = std::clamp(selected - rows / 2, 0, std::max(0, static_cast<int>(pairs.size()) - rows));
  for (int row = 0; row < rows && first + row < static_cast<int>(pairs.size()); ++row) {
    const int index = first + row, y = top + row;
    const PairState& pair = pairs[static_cast<std::size_t>(index)];
    if (index == selected && pane.width() >= 20) pane.text(0, y, symbols(charset).cursor, Style::key);
    for (const PlacedColumn& column : columns)
      if (const auto cell = cell_of(pair, column, index == selected, model.now(), charset))
        draw_cell(pane, y, column, *cell);
  }
}

}  // namespace egocal::monitor
