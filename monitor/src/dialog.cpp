// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "dialog.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "answer_text.hpp"
#include "egocal/monitor/layout.hpp"

namespace egocal::monitor {

namespace {

struct Text {
  std::string title;
  std::vector<std::string> lines;
};

/// The keys one behind the other, in rows of this width.
std::vector<std::string> all_keys_in(int width) {
  std::vector<std::string> rows;
  for (const std::string key :
       {"q quit", "Enter detail", "Esc back", "n N pair", "up dn choose", "e events", "s streams", "+ - zoom",
        "l axes", "x export", "r reset", "p pause", "spc pause view", "^L redraw", "^Z suspend"}) {
    const std::string between = "  ";
    if (rows.empty() || width_of(rows.back() + between + key) > width)
      rows.push_back(key);
    else
      rows.back() += between + key;
  }
  return rows;
}

Text help(const ViewState& view, int width, int height) {
  if (width < 66 || height < 16) return {"Keys", all_keys_in(width - 4)};
  return {"Keys",
          {"q        quit                      Enter    detail of the pair",
           "up down  choose a pair, scroll     Esc      back to the overview",
           "n N      next, previous pair       e        events",
           "+ -      zoom the time             l        log or linear axes",
           "space    pause the view only       x        export the answer",
           "r        reset the calibration     p        pause or resume it", "s        the sensors' streams",
           "Ctrl-L   draw again                Ctrl-Z   suspend", "",
           "good, incomplete, doubtful, contradictory: can it be used?",
           "optimal (proven): the best fit to the motions, right or wrong.",
           "gap of 1: distance to that proof, in units of its limit.",
           std::string(symbols(view.charset).plus_minus) +
               " and the bars: how well the motions show it (one sigma).",
           "cyan: fast solver, magenta: global solver"}};
}

Text text_of(const PairState* pair, const ViewState& view, int width, int height) {
  const std::string which = pair ? pair_title(*pair, view.charset, 20) : "";
  switch (view.dialog) {
    case Dialog::help:
      return help(view, width, height);
    case Dialog::reset:
      return {"Reset",
              {"Forget all motions of " + which + "?", "", "y  yes, start again", "any other key  no"}};
    case Dialog::pause:
      return {"Pause",
              {"Pause the calibration of " + which + "?", "Motions in the meantime are not used.", "",
               "y  yes", "any other key  no"}};
    case Dialog::resume:
      return {"Resume", {"Resume the calibration of " + which + "?", "", "y  yes", "any other key  no"}};
    case Dialog::export_format:
      return {"Export",
              {"Write the answer of " + which + " to a file:", "", "y YAML  r ROS  u URDF  k Kalibr",
               "any other key  nothing"}};
    case Dialog::none:
      break;
  }
  return {};
}

/// A question on a screen that is too small for sentences: the pair, and the keys.
Text short_text_of(const PairState& pair, const ViewState& view, int width) {
  const std::string which = pair_in(pair.a, pair.b, width - 1, view.charset) + "?";
  switch (view.dialog) {
    case Dialog::reset:
      return {"Reset", {which, "y yes", "other key no"}};
    case Dialog::pause:
      return {"Pause", {which, "y yes", "other key no"}};
    case Dialog::resume:
      return {"Resume", {which, "y yes", "other key no"}};
    case Dialog::export_format:
      return {"Export", {which, "y YAML  r ROS", "u URDF  k Kalibr"}};
    case Dialog::help:
    case Dialog::none:
      break;
  }
  return {};
}

/// The lines broken at blanks, where there is one, into rows of this width.
std::vector<std::string> rows_of(const std::vector<std::string>& lines, int width) {
  std::vector<std::string> out;
  for (std::string line : lines) {
    while (width_of(line) > width) {
      std::size_t cut = line.rfind(' ', static_cast<std::size_t>(std::max(width, 1)));
      if (cut == std::string::npos || cut == 0) break;
      out.push_back(line.substr(0, cut));
      line.erase(0, cut + 1);
    }
    out.push_back(line);
  }
  return out;
}

void draw_frame(const Pane& pane, const std::string& title, Charset charset) {
  const bool unicode = charset == Charset::unicode;
  const int right = pane.width() - 1, bottom = pane.height() - 1;
  for (int x = 0; x <= right; ++x)
    for (const int y : {0, bottom}) pane.text(x, y, unicode ? "─" : "-", Style::dim);
  for (int y = 0; y <= bottom; ++y)
    for (const int x : {0, right}) pane.text(x, y, unicode ? "│" : "|", Style::dim);
  pane.text(0, 0, unicode ? "┌" : "+", Style::dim);
  pane.text(right, 0, unicode ? "┐" : "+", Style::dim);
  pane.text(0, bottom, unicode ? "└" : "+", Style::dim);
  pane.text(right, bottom, unicode ? "┘" : "+", Style::dim);
  pane.text(2, 0, " " + title + " ", Style::title);
}

}  // namespace

void draw_dialog(Canvas& canvas, const PairState* pair, const ViewState& view) {
  if (view.dialog == Dialog::none) return;
  Text text = text_of(pair, view, canvas.width(), canvas.height());
  text.lines = rows_of(text.lines, canvas.width() - 4);
  // what must be read does not give way to blank lines, nor to whole sentences
  const auto fits = [&] { return static_cast<int>(text.lines.size()) + 2 <= canvas.height(); };
  if (!fits()) std::erase(text.lines, "");
  if (!fits() && pair && view.dialog != Dialog::help) text = short_text_of(*pair, view, canvas.width() - 4);
  int wanted = 0;
  for (const std::string& line : text.lines) wanted = std::max(wanted, width_of(line));
  const Rect box =
      layout_dialog(canvas.width(), canvas.height(), wanted + 4, static_cast<int>(text.lines.size()) + 2);
  const Pane pane(canvas, box);
  pane.clear();
  draw_frame(pane, text.title, view.charset);
  const Pane inner = pane.part({2, 1, box.w - 4, box.h - 2});
  for (std::size_t i = 0; i < text.lines.size(); ++i) inner.text(0, static_cast<int>(i), text.lines[i]);
}

}  // namespace egocal::monitor
