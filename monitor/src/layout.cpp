// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/layout.hpp"

#include <algorithm>

namespace egocal::monitor {
namespace {

constexpr int summary_rows = 4;       // rows of the screen
constexpr int most_verdict_rows = 4;  // rows of the screen

struct Frame {
  Rect header, body, keys;
};

Frame frame_of(int width, int height) {
  width = std::max(0, width);
  height = std::max(0, height);
  Frame frame;
  const int header = height >= 3 ? 1 : 0, keys = height >= 5 ? 1 : 0;
  frame.header = {0, 0, width, header};
  frame.body = {0, header, width, height - header - keys};
  frame.keys = {0, height - keys, width, keys};
  return frame;
}

}  // namespace

OverviewLayout layout_overview(int width, int height, int pairs, int processes, int streams) {
  const Frame frame = frame_of(width, height);
  OverviewLayout layout;
  layout.header = frame.header;
  layout.keys = frame.keys;
  const int rows = frame.body.h;
  pairs = std::max(1, pairs);
  processes = std::max(1, processes);
  layout.titles = rows >= 8;
  if (!layout.titles) {
    layout.pairs = frame.body;
    if (rows >= pairs + summary_rows) {  // room for the chosen pair in full
      layout.pairs.h = rows - summary_rows;
      layout.summary = {0, frame.body.y + layout.pairs.h, width, summary_rows};
    }
    return layout;
  }
  // all processes, as long as the pairs keep the larger half
  const int table_rows = 2 + pairs;
  const int process_rows =
      std::clamp(processes + 1, 2, std::max(2, std::min(rows / 3, rows - std::min(table_rows, rows / 2))));
  // and what is wrong with the streams before the events
  const int stream_rows =
      streams > 0 ? std::min(streams + 1, std::max(0, rows - process_rows - std::max(table_rows, rows / 3)))
                  : 0;
  int left = rows - process_rows - (stream_rows >= 2 ? stream_rows : 0);
  for (int card : {6, 5, 4})
    if (width >= 76 && layout.card_rows == 0 && 1 + card * pairs <= left) layout.card_rows = card;
  const int wanted = layout.card_rows > 0 ? 1 + layout.card_rows * pairs : table_rows;
  const int pair_rows = std::min(wanted, left);
  left -= pair_rows;
  const int event_rows = left >= 2 ? left : 0;
  const int shown_streams = stream_rows >= 2 ? stream_rows : 0;
  layout.pairs = {0, frame.body.y, width, rows - process_rows - event_rows - shown_streams};
  layout.streams = {0, layout.pairs.y + layout.pairs.h, width, shown_streams};
  layout.processes = {0, layout.streams.y + shown_streams, width, process_rows};
  layout.events = {0, layout.processes.y + process_rows, width, event_rows};
  return layout;
}

std::vector<PlacedColumn> layout_pair_table(int width) {
  struct Wish {
    PairColumn column;
    int width;
    int rank;  // what is given room first
  };
  // from left to right
  constexpr Wish wishes[] = {{PairColumn::name, 16, 1},          {PairColumn::verdict, 15, 0},
                             {PairColumn::proof, 7, 5},          {PairColumn::error_translation, 9, 3},
                             {PairColumn::error_rotation, 8, 4}, {PairColumn::translation, 29, 8},
                             {PairColumn::rotation, 29, 9},      {PairColumn::gap, 8, 10},
                             {PairColumn::motions, 7, 6},        {PairColumn::solver, 10, 7},
                             {PairColumn::solve, 7, 11},         {PairColumn::verify, 7, 12},
                             {PairColumn::latency, 7, 13},       {PairColumn::age, 6, 2}};
  // without room for both the verdict is cut: it is known by its begin, a pair only by its name
  constexpr int whole_name = 16, whole_verdict = 15, enough_of_name = 10, least = 8;
  if (width < 2 + whole_name + whole_verdict && width >= 2 + 2 * least) {
    const int verdict = std::clamp(width - 2 - enough_of_name, least, whole_verdict),
              name = width - 2 - verdict;
    return {{PairColumn::name, 1, name}, {PairColumn::verdict, 2 + name, verdict}};
  }
  std::array<bool, std::size(wishes)> chosen{};
  int used = 1;  // the cursor's column
  for (int rank = 0; rank < static_cast<int>(std::size(wishes)); ++rank)
    for (std::size_t i = 0; i < std::size(wishes); ++i)
      if (wishes[i].rank == rank && used + wishes[i].width <= width) {
        chosen[i] = true;
        used += wishes[i].width + 1;
      }
  std::vector<PlacedColumn> columns;
  int x = 1;
  for (std::size_t i = 0; i < std::size(wishes); ++i) {
    if (!chosen[i]) continue;
    int w = wishes[i].width;
    if (wishes[i].column == PairColumn::name)
      w += std::clamp(width - used, 0, 20);  // names take what is left over
    columns.push_back({wishes[i].column, x, w});
    x += w + 1;
  }
  if (columns.empty() && width > 0) columns.push_back({PairColumn::verdict, 0, width});
  return columns;
}

DetailLayout layout_detail(int width, int height) {
  const Frame frame = frame_of(width, height);
  DetailLayout layout;
  layout.header = frame.header;
  layout.keys = frame.keys;
  const Rect body = frame.body;

  const auto place_plots = [&](const Rect& area) {
    const int columns = area.w >= 40 ? 2 : 1, rows = 4 / columns;
    if (area.w < 20 || area.h < 4) return;
    const int shown_rows = std::min(rows, area.h / 4);  // a curve needs four rows to say anything
    for (int i = 0; i < shown_rows * columns; ++i) {
      const int column = i % columns, row = i / columns;
      const int x0 = area.w * column / columns, x1 = area.w * (column + 1) / columns;
      const int y0 = area.h * row / shown_rows, y1 = area.h * (row + 1) / shown_rows;
      layout.plots[static_cast<std::size_t>(i)] = {area.x + x0, area.y + y0, x1 - x0, y1 - y0};
    }
  };

  if (body.w >= 76 && body.h >= 18) {
    const int verdict_rows = std::clamp(body.h - 18, 0, most_verdict_rows);
    layout.verdict = {0, body.y, body.w, verdict_rows};
    const int top = body.y + verdict_rows, rows = body.h - verdict_rows;
    layout.matrices = rows >= 24;
    const int direction_rows = layout.matrices ? 7 : 4;
    const int upper = rows - direction_rows;
    const int side = std::clamp(body.w * 38 / 100, 30, 46);
    place_plots({0, top, body.w - side, upper});
    layout.observability = {body.w - side, top, side, 8};
    layout.solvers = {body.w - side, top + 8, side, upper - 8};
    const int half = body.w / 2;
    layout.directions[0] = {0, top + upper, half, direction_rows};
    layout.directions[1] = {half, top + upper, body.w - half, direction_rows};
    return layout;
  }

  const int summary = std::min(body.h, summary_rows);
  layout.summary = {0, body.y, body.w, summary};
  Rect rest{0, body.y + summary, body.w, body.h - summary};
  if (rest.h >= 8 + 8 && rest.w >= 28) {
    layout.observability = {0, rest.y, rest.w, 8};
    rest = {0, rest.y + 8, rest.w, rest.h - 8};
  }
  place_plots(rest);
  return layout;
}

EventsLayout layout_events(int width, int height) {
  const Frame frame = frame_of(width, height);
  return {frame.header, frame.body, frame.keys};
}

Rect layout_dialog(int width, int height, int wanted_width, int wanted_height) {
  const int w = std::clamp(wanted_width, 0, std::max(0, width)),
            h = std::clamp(wanted_height, 0, std::max(0, height));
  return {(std::max(0, width) - w) / 2, (std::max(0, height) - h) / 2, w, h};
}

}  // namespace egocal::monitor
