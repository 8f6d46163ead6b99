// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "panels.hpp"

namespace egocal::monitor {

namespace {

struct Line {
  std::string text;
  Style style;
};

Style style_of(bus::StreamLine::Severity severity) {
  switch (severity) {
    case bus::StreamLine::Severity::good:
      return Style::normal;
    case bus::StreamLine::Severity::warning:
      return Style::warning;
    case bus::StreamLine::Severity::bad:
      break;
  }
  return Style::bad;
}

constexpr int going_on = 6;  // of a line that goes on: behind those of a sensor's faults

std::size_t room(int width) {
  return static_cast<std::size_t>(std::max(1, width - 3));
}

/// all: also what processes reject, and whole lines, however many rows they take.
std::vector<Line> lines_of(const Model& model, bool all, int width) {
  std::vector<Line> lines;
  for (const bus::StreamLine& line : model.streams()) lines.push_back({line.text, style_of(line.severity)});
  if (!all) return lines;
  for (const ProcessState& process : model.processes())
    for (const bus::Refusal& refusal : process.rejections)
      lines.push_back({process.status.name + " rejected " + count(refusal.count) + " x " + refusal.reason +
                           (refusal.cure.empty() ? "" : ": " + refusal.cure),
                       Style::dim});
  std::vector<Line> rows;
  for (const Line& line : lines)
    for (std::string& row : wrapped(line.text, room(width), going_on))
      rows.push_back({std::move(row), line.style});
  return rows;
}

}  // namespace

int stream_line_count(const Model& model, int width) {
  return static_cast<int>(lines_of(model, true, width).size());
}

void draw_streams(const Pane& pane, const Model& model, int scroll, bool all, Charset charset) {
  const int top = pane.height() >= 2 ? 1 : 0;
  if (top) draw_title(pane, "Streams", charset);
  const std::vector<Line> lines = lines_of(model, all, pane.width());
  if (lines.empty()) {
    pane.text(2, top, "not watched: this is a log, or no rig file was given", Style::dim);
    return;
  }
  for (int y = top; y < pane.height(); ++y) {
    const int i = scroll + y - top;
    if (i < 0 || i >= static_cast<int>(lines.size())) break;
    const Line& line = lines[static_cast<std::size_t>(i)];
    if (pane.width() > 3) pane.text(2, y, clean(line.text, room(pane.width())), line.style);
  }
}

}  // namespace egocal::monitor
