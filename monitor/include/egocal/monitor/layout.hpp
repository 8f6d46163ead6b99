// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "egocal/monitor/canvas.hpp"

namespace egocal::monitor {

// Computes rectangles from sizes. Rectangles never overlap and never leave the screen; an empty one is not
// drawn. The answers get room first.

struct OverviewLayout {
  Rect header, pairs, processes, events, keys;
  Rect streams;         ///< empty where there is nothing to say of them
  Rect summary;         ///< of the chosen pair, where there is no room for processes and events
  bool titles = false;  ///< the first row of pairs, processes and events is a title
  int card_rows = 0;    ///< rows of one pair's card; 0: a table, one row a pair
};
/// streams: lines to be said of the sensors' streams.
OverviewLayout layout_overview(int width, int height, int pairs, int processes, int streams = 0);

/// The table of pairs: which columns fit.
enum class PairColumn {
  name,
  verdict,
  proof,
  error_translation,
  error_rotation,
  motions,
  solver,
  translation,
  rotation,
  gap,
  age,
  solve,
  verify,
  latency
};
struct PlacedColumn {
  PairColumn column;
  int x = 0, width = 0;
};
/// The columns from left to right, with one blank between them.
std::vector<PlacedColumn> layout_pair_table(int width);

struct DetailLayout {
  Rect header;
  Rect verdict;               ///< in words, above all the rest
  Rect summary;               ///< the answer in three lines, where there is no room for the panels below
  std::array<Rect, 4> plots;  ///< rotation error, translation error, scaled gap, execution time
  Rect observability, solvers;
  std::array<Rect, 2> directions;  ///< T_a_b and T_b_a
  bool matrices = false;           ///< the directions have room for their matrices
  Rect keys;
};
DetailLayout layout_detail(int width, int height);

struct EventsLayout {
  Rect header, list, keys;
};
EventsLayout layout_events(int width, int height);

/// A box in the middle of the screen, as large as wanted or as fits.
Rect layout_dialog(int width, int height, int wanted_width, int wanted_height);

}  // namespace egocal::monitor
