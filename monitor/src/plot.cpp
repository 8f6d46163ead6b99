// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace egocal::monitor {
namespace {

// Dots that know to which cell they belong.
class Dots {
 public:
  Dots(int cells_wide, int cells_high, Charset charset)
      : charset_(charset), w_(cells_wide), h_(cells_high), cells_(static_cast<std::size_t>(w_ * h_)) {}
  int width() const { return charset_ == Charset::unicode ? 2 * w_ : w_; }
  int height() const { return charset_ == Charset::unicode ? 4 * h_ : h_; }

  void set(int x, int y, Style style) {
    if (x < 0 || y < 0 || x >= width() || y >= height()) return;
    static constexpr unsigned dot_bits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    if (charset_ == Charset::unicode) {
      Dot& cell = cells_[static_cast<std::size_t>(y / 4 * w_ + x / 2)];
      cell.bits |= dot_bits[y % 4][x % 2];
      cell.style = style;
    } else {
      Dot& cell = cells_[static_cast<std::size_t>(y * w_ + x)];
      cell.bits = 1;
      cell.style = style;
    }
  }

  void draw(const Pane& pane) const {
    for (int y = 0; y < h_; ++y)
      for (int x = 0; x < w_; ++x) {
        const Dot& cell = cells_[static_cast<std::size_t>(y * w_ + x)];
        if (cell.bits)
          pane.put(x, y, {charset_ == Charset::unicode ? U'\u2800' + cell.bits : U'*', cell.style, false});
      }
  }

 private:
  struct Dot {
    unsigned bits = 0;
    Style style = Style::normal;
  };
  Charset charset_;
  int w_, h_;
  std::vector<Dot> cells_;
};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return !(low <= high); }
};

// The next larger of 1, 2, 5, 10, 20...
double round_step(double size) {
  const double decade = std::pow(10.0, std::floor(std::log10(size)));
  for (double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= size * (1 - 1e-9)) return factor * decade;
  return 10 * decade;
}

constexpr int scale_width = 8;  // of the numbers at the axis

bool usable(const Plot& plot, double value) {
  return std::isfinite(value) && (!plot.logarithmic || value > 0);
}

double axis_value(const Plot& plot, double value) {
  return plot.logarithmic ? std::log10(value) : value;
}

/// The range of the values of all curves within the time that is shown.
Range range_of(const Plot& plot) {
  Range range;
  for (const PlotSeries& series : plot.series) {
    for (const Slice& slice : series.history->since(plot.begin)) {
      if (slice.begin < plot.begin - 1 || slice.begin > plot.end) continue;
      for (float raw : {slice.low[plot.curve], slice.high[plot.curve]}) {
        const double value = static_cast<double>(raw) * plot.scale;
        if (usable(plot, value)) range.take(value);
      }
    }
  }
  return range;
}

/// What the rows of the plot mean; logarithmic: in decades.
struct Axis {
  double low = 0, high = 1, step = 1;
  int rows = 1;

  int row_of(double axis) const {
    return static_cast<int>(std::lround((high - axis) / (high - low) * (rows - 1)));
  }
};

Axis axis_of(const Plot& plot, const Range& range, int rows) {
  Axis axis{range.low, range.high, 1, rows};
  if (plot.logarithmic) {
    // values are kept in single precision, where 0.01 may be slightly less
    axis.low = std::max(std::floor(std::log10(axis.low) + 1e-6), std::log10(axis.high) - 15);
    axis.high = std::ceil(std::log10(axis.high) - 1e-6);
    if (axis.high - axis.low < 1) axis.high = axis.low + 1;
    return axis;
  }
  if (axis.low > 0 && axis.low < 0.6 * axis.high) axis.low = 0;
  // from round number to round number, a few of them in between
  axis.step = round_step(std::max(axis.high - axis.low, 1e-6 * std::max(1e-30, std::abs(axis.high))) /
                         std::clamp((rows - 1) / 2, 1, 5));
  axis.low = std::floor(axis.low / axis.step + 1e-6) * axis.step;
  axis.high = std::max(std::ceil(axis.high / axis.step - 1e-6) * axis.step, axis.low + axis.step);
  return axis;
}

/// Numbers at the axis: every decade that fits, or the ends and the middle.
void draw_value_axis(const Pane& pane, const Plot& plot, const Axis& axis, Charset charset) {
  const int h = axis.rows;
  const auto label = [&](double at) {
    const double value = plot.logarithmic ? std::pow(10.0, at) : at;
    const int row = axis.row_of(at);
    if (row < 0 || row >= h) return;
    pane.text(0, 1 + row, pad_left(compact(value, charset), scale_width - 1), Style::dim);
    pane.text(scale_width, 1 + row, charset == Charset::unicode ? "┤" : "+", Style::dim);
  };
  for (int row = 0; row < h; ++row)
    pane.text(scale_width, 1 + row, charset == Charset::unicode ? "│" : "|", Style::dim);
  if (plot.logarithmic) {
    const int decades = static_cast<int>(axis.high - axis.low);
    const int every = std::max(1, (2 * decades + h - 1) / std::max(1, h));
    for (int d = 0; d <= decades; d += every) label(axis.low + d);
  } else {
    for (int i = 0; i <= 12 && axis.low + i * axis.step <= axis.high + 0.1 * axis.step; ++i)
      label(axis.low + i * axis.step);
  }
}

void draw_time_axis(const Pane& pane, const Plot& plot, int w, int h, Charset charset) {
  const double span = plot.end - plot.begin;
  const auto time_text = [&](double time) { return number(time, span < 10 ? 1 : 0, charset); };
  const std::string from = time_text(plot.begin), to = time_text(plot.end) + " s",
                    middle = time_text(plot.begin + 0.5 * span);
  pane.text(scale_width, 1 + h, charset == Charset::unicode ? "└" : "+", Style::dim);
  for (int x = 0; x < w; ++x) pane.text(scale_width + 1 + x, 1 + h, symbols(charset).line, Style::dim);
  pane.text(scale_width + 1, 1 + h, from, Style::dim);
  if (w > width_of(from) + width_of(to) + 1)
    pane.text(scale_width + 1 + w - width_of(to), 1 + h, to, Style::dim);
  if (w > 2 * (width_of(to) + width_of(middle)) + 6)
    pane.text(scale_width + 1 + (w - width_of(middle)) / 2, 1 + h, middle, Style::dim);
}

/// Draws the threshold, its meaning beside the title, and the moves of the mount.
void draw_marks(const Pane& pane, const Pane& field, const Plot& plot, const Axis& axis, int w,
                Charset charset) {
  const double span = plot.end - plot.begin;
  const int h = axis.rows;
  const auto column_of = [&](double time) { return static_cast<int>((time - plot.begin) / span * (w - 1)); };
  if (plot.threshold && usable(plot, *plot.threshold)) {
    const int row = axis.row_of(axis_value(plot, *plot.threshold));
    for (int x = 0; x < w; ++x) field.text(x, row, charset == Charset::unicode ? "╌" : "-", Style::threshold);
  }
  if (plot.mark && span > 0 && *plot.mark >= plot.begin && *plot.mark <= plot.end) {
    const int x = column_of(*plot.mark);
    const std::string line = charset == Charset::unicode ? "┊" : ":";
    for (int y = 0; y < h; ++y) field.text(x, y, line, Style::global);
    const std::string meaning = line + " " + plot.mark_label;
    if (!plot.mark_label.empty() && width_of(plot.title) + width_of(meaning) + 4 <= pane.width())
      pane.text(pane.width() - width_of(meaning) - 1, 0, meaning, Style::global);
  }
  for (const double move : plot.moves)
    if (span > 0 && move >= plot.begin && move <= plot.end) {
      const int x = column_of(move);
      for (int y = 0; y < h; ++y) field.text(x, y, charset == Charset::unicode ? "┃" : "|", Style::bad);
    }
}

/// Range of one curve in each column of dots.
std::vector<Range> columns_of(const Plot& plot, const PlotSeries& series, int width) {
  const double span = plot.end - plot.begin;
  std::vector<Range> columns(static_cast<std::size_t>(width));
  for (const Slice& slice : series.history->since(plot.begin)) {
    const double x = (slice.begin - plot.begin) / span * width;
    if (!(x > -1) || !(x < width)) continue;
    Range& column = columns[static_cast<std::size_t>(std::max(0.0, x))];
    for (float raw : {slice.low[plot.curve], slice.high[plot.curve]}) {
      const double value = static_cast<double>(raw) * plot.scale;
      if (usable(plot, value)) column.take(axis_value(plot, value));
    }
  }
  return columns;
}

/// Joins a column of dots with the last one before it.
void join(Dots& dots, int last_x, int last_y, int x, int target, Style style) {
  for (int k = last_x + 1; k <= x; ++k) {
    const double s = static_cast<double>(k - last_x) / (x - last_x);
    const int from_y = static_cast<int>(std::lround(last_y + (s - 1.0 / (x - last_x)) * (target - last_y)));
    const int to_y = static_cast<int>(std::lround(last_y + s * (target - last_y)));
    for (int y = std::min(from_y, to_y); y <= std::max(from_y, to_y); ++y) dots.set(k, y, style);
  }
}

void draw_series(Dots& dots, const Plot& plot, const PlotSeries& series, const Axis& axis) {
  const std::vector<Range> columns = columns_of(plot, series, dots.width());
  const auto y_of = [&](double at) {
    return static_cast<int>(
        std::lround(std::clamp((axis.high - at) / (axis.high - axis.low), 0.0, 1.0) * (dots.height() - 1)));
  };
  // neighbouring slices are joined, also over the empty columns between two slices; true gaps stay open
  const double columns_per_slice =
      series.history->slice_width(series.history->since(plot.begin)) / (plot.end - plot.begin) * dots.width();
  const int bridge = static_cast<int>(std::min(1e4, std::max(2.0, 3 * columns_per_slice + 1)));
  int last_x = -1, last_y = 0;
  for (int x = 0; x < dots.width(); ++x) {
    const Range& column = columns[static_cast<std::size_t>(x)];
    if (column.empty()) continue;
    const int top = y_of(column.high), bottom = y_of(column.low);
    for (int y = top; y <= bottom; ++y) dots.set(x, y, series.style);
    if (last_x >= 0 && x - last_x <= bridge)
      join(dots, last_x, last_y, x, std::clamp(last_y, top, bottom), series.style);
    last_x = x;
    last_y = (top + bottom) / 2;
  }
}

}  // namespace

void draw_plot(const Pane& pane, const Plot& plot, Charset charset) {
  const int w = pane.width() - scale_width - 2, h = pane.height() - 2;
  pane.text(1, 0, pad_right(plot.title, pane.width() - 1), Style::strong);
  if (w < 4 || h < 1) return;

  Range range = range_of(plot);
  const bool nothing = range.empty();
  if (plot.threshold && usable(plot, *plot.threshold)) range.take(*plot.threshold);
  if (range.empty()) {
    const std::string text = "no values yet";
    pane.text(scale_width + std::max(0, (w - width_of(text)) / 2), 1 + h / 2, text, Style::dim);
    return;
  }
  const Axis axis = axis_of(plot, range, h);
  draw_value_axis(pane, plot, axis, charset);
  draw_time_axis(pane, plot, w, h, charset);
  const Pane field = pane.part({scale_width + 1, 1, w, h});
  draw_marks(pane, field, plot, axis, w, charset);
  if (nothing || !(plot.end - plot.begin > 0)) return;

  Dots dots(w, h, charset);
  for (const PlotSeries& series : plot.series) draw_series(dots, plot, series, axis);
  dots.draw(field);
}

}  // namespace egocal::monitor
