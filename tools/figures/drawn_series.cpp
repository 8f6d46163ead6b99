// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "figures/drawn_series.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "figures/elements.hpp"

namespace egocal::tools {

namespace {

std::string band(const Series& series, const Plot& plot, const Frame& frame) {
  if (series.low.size() != series.x.size() || series.high.size() != series.x.size()) return "";
  std::string upper, lower;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!drawable(plot.x, series.x[i]) || !drawable(plot.y, series.low[i]) ||
        !drawable(plot.y, series.high[i]))
      continue;
    upper += fmt::format("{:.2f},{:.2f} ", frame.x(series.x[i]), frame.y(series.high[i]));
    lower = fmt::format("{:.2f},{:.2f} ", frame.x(series.x[i]), frame.y(series.low[i])) + lower;
  }
  return fmt::format("<polygon points='{}{}' fill='{}' fill-opacity='0.18'/>\n", upper, lower,
                     hex(series.colour));
}

std::string polyline(const std::string& points, const Series& series) {
  if (points.empty()) return "";
  const char* dashes = dashes_of(series);
  return fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='1.1'{}/>\n", points,
                     hex(series.colour), dashes);
}

std::string lines(const Series& series, const Plot& plot, const Frame& frame) {
  std::string out;
  std::vector<Point> points;
  const auto draw = [&] {
    std::string text;
    for (const Point& point : thinned_line(points, plot.thinning))
      text += fmt::format("{:.2f},{:.2f} ", point.x, point.y);
    out += polyline(text, series);
    points.clear();
  };
  for (std::size_t i = 0; i < series.x.size(); ++i)
    if (drawable(plot.x, series.x[i]) && drawable(plot.y, series.y[i]))
      points.push_back({frame.x(series.x[i]), frame.y(series.y[i])});
    else
      draw();
  draw();
  return out;
}

/// Round caps of lines without a length: a third of the bytes of circles.
std::string many_dots(const std::vector<Point>& points, const Series& series) {
  std::string path;
  for (const Point& point : points) path += fmt::format("M{:.2f},{:.2f}h0", point.x, point.y);
  return fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='{:g}' stroke-linecap='round'/>\n",
                     path, hex(series.colour), 2 * series.radius);
}

std::string dots(const Series& series, const Plot& plot, const Frame& frame) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < series.x.size(); ++i)
    if (drawable(plot.x, series.x[i]) && drawable(plot.y, series.y[i]))
      points.push_back({frame.x(series.x[i]), frame.y(series.y[i])});
  if (series.style == Series::Style::points && points.size() >= plot.thinning.least_points) {
    std::erase_if(points, [&](const Point& point) {
      return !(point.x >= 0 && point.x <= plot.width && point.y >= 0 && point.y <= plot.height);
    });
    return many_dots(thinned_dots(points, series.radius, plot.thinning), series);
  }
  std::string out;
  for (const Point& point : points) out += circle(point.x, point.y, series.radius, series);
  return out;
}

std::string bars(const Series& series, const Plot& plot, const Frame& frame) {
  if (series.x.empty()) return "";
  const double step = series.x.size() > 1 ? frame.x(series.x[1]) - frame.x(series.x[0]) : frame.width() / 2;
  const double base = margin_top + frame.height();
  std::string out;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!drawable(plot.y, series.y[i])) continue;
    const double y = frame.y(series.y[i]);
    out += fmt::format("<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' fill='{}'/>\n",
                       frame.x(series.x[i]) - 0.45 * step, y, 0.9 * step, std::max(0.0, base - y),
                       hex(series.colour));
  }
  return out;
}

}  // namespace

std::string drawn(const Series& series, const Plot& plot, const Frame& frame) {
  switch (series.style) {
    case Series::Style::points:
    case Series::Style::rings:
      return dots(series, plot, frame);
    case Series::Style::bars:
      return bars(series, plot, frame);
    case Series::Style::line:
    case Series::Style::dashes:
    case Series::Style::dotted:
      break;
  }
  return band(series, plot, frame) + lines(series, plot, frame);
}

}  // namespace egocal::tools
