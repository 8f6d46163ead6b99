// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/canvas.hpp"

#include <algorithm>

#include "egocal/monitor/text.hpp"

namespace egocal::monitor {

Rect intersection(const Rect& a, const Rect& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  return {x, y, std::max(0, std::min(a.x + a.w, b.x + b.w) - x),
          std::max(0, std::min(a.y + a.h, b.y + b.h) - y)};
}

Canvas::Canvas(int width, int height)
    : width_(std::max(0, width)),
      height_(std::max(0, height)),
      cells_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

void Canvas::put(int x, int y, const Cell& cell) {
  if (x >= 0 && y >= 0 && x < width_ && y < height_) cells_[index(x, y)] = cell;
}

std::string Canvas::to_text() const {
  std::string text;
  for (int y = 0; y < height_; ++y) {
    std::string line;
    for (int x = 0; x < width_; ++x) append_utf8(line, at(x, y).glyph);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

void Pane::put(int x, int y, const Cell& cell) const {
  if (x >= 0 && y >= 0 && x < rect_.w && y < rect_.h) canvas_->put(rect_.x + x, rect_.y + y, cell);
}

int Pane::text(int x, int y, std::string_view utf8, Style style, bool reverse) const {
  for (char32_t glyph : decode(utf8))
    put(x++, y, {glyph < 0x20 || glyph == 0x7f ? U'?' : glyph, style, reverse});
  return x;
}

Pane Pane::part(const Rect& rect) const {
  return {*canvas_, intersection(rect_, {rect_.x + rect.x, rect_.y + rect.y, rect.w, rect.h})};
}

void Pane::clear() const {
  for (int y = 0; y < rect_.h; ++y)
    for (int x = 0; x < rect_.w; ++x) put(x, y, {});
}

}  // namespace egocal::monitor
