// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace egocal::monitor {

struct Rect {
  int x = 0, y = 0, w = 0, h = 0;
  bool empty() const { return w <= 0 || h <= 0; }
  bool operator==(const Rect&) const = default;
};
Rect intersection(const Rect& a, const Rect& b);

/// What a cell means; the terminal's scheme makes it a colour, bold, or nothing.
enum class Style : std::uint8_t {
  normal,
  dim,
  strong,
  title,
  good,
  warning,
  bad,
  fast,
  global,
  threshold,
  key,
  count_
};

struct Cell {
  char32_t glyph = U' ';
  Style style = Style::normal;
  bool reverse = false;
  bool operator==(const Cell&) const = default;
};

/// A grid of cells: what the views draw into. Knows no terminal.
class Canvas {
 public:
  Canvas(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  Rect area() const { return {0, 0, width_, height_}; }
  const Cell& at(int x, int y) const { return cells_[index(x, y)]; }
  void put(int x, int y, const Cell& cell);  ///< outside: nothing happens
  /// A line per row, blanks at its end removed.
  std::string to_text() const;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_, height_;
  std::vector<Cell> cells_;
};

/// A rectangle of the canvas with coordinates of its own; what falls outside of it is not drawn.
class Pane {
 public:
  Pane(Canvas& canvas, const Rect& rect) : canvas_(&canvas), rect_(rect) {}
  explicit Pane(Canvas& canvas) : Pane(canvas, canvas.area()) {}
  int width() const { return rect_.w; }
  int height() const { return rect_.h; }
  void put(int x, int y, const Cell& cell) const;
  /// Returns the column behind the text.
  int text(int x, int y, std::string_view utf8, Style style = Style::normal, bool reverse = false) const;
  Pane part(const Rect& rect) const;  ///< rect in this pane's coordinates
  void clear() const;

 private:
  Canvas* canvas_;
  Rect rect_;
};

}  // namespace egocal::monitor
