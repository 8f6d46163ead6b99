// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "egocal/monitor/canvas.hpp"
#include "egocal/monitor/history.hpp"
#include "egocal/monitor/text.hpp"

namespace egocal::monitor {

struct PlotSeries {
  const History* history = nullptr;
  Style style = Style::normal;
};

struct Plot {
  std::string title;  ///< with the unit
  Curve curve = rotation_error;
  double scale = 1;  ///< from SI to the unit shown
  bool logarithmic = true;
  double begin = 0, end = 1;        ///< [s]
  std::optional<double> threshold;  ///< in the unit shown; a line across
  std::optional<double> mark;       ///< [s]; a line down
  std::string mark_label;           ///< what it means; beside the title, where there is room
  std::vector<double> moves;  ///< [s]; when the mount moved: a line down each, in the colour of what is bad
  std::vector<PlotSeries> series;
};

/// Draws the curves with numbers at the axes: title above, time below. Braille dots, 2 x 4 a cell, or ASCII.
void draw_plot(const Pane& pane, const Plot& plot, Charset charset);

}  // namespace egocal::monitor
