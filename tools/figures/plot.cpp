// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "figures/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/axes.hpp"
#include "figures/drawn_series.hpp"
#include "figures/elements.hpp"
#include "figures/frame.hpp"
#include "figures/legend.hpp"

namespace egocal::tools {

namespace {

std::string drawn(const Marker& marker, const Frame& frame) {
  constexpr const char* style = "stroke='#404040' stroke-width='0.8' stroke-dasharray='2 2'";
  if (marker.vertical) {
    const double x = frame.x(marker.at);
    return line_element(x, margin_top, x, margin_top + frame.height(), style) +
           text_element(x + 2, margin_top + font_size + 1, "start", marker.label);
  }
  const double y = frame.y(marker.at);
  const double label = y - 2 - font_size > margin_top ? y - 2 : y + font_size;
  return line_element(margin_left, y, margin_left + frame.width(), y, style) +
         text_element(margin_left + frame.width() - 2, label, "end", marker.label);
}

}  // namespace

Series histogram(const std::vector<double>& values, int bins, Colour colour) {
  Series series;
  series.style = Series::Style::bars;
  series.colour = colour;
  AxisRange range;
  for (const double value : values)
    if (std::isfinite(value)) range.include(value);
  if (range.empty() || bins < 1) return series;
  const double width = std::max((range.most - range.least) / bins, 1e-300);
  for (int i = 0; i < bins; ++i) {
    series.x.push_back(range.least + (i + 0.5) * width);
    series.y.push_back(0);
  }
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    const int bin = std::min(bins - 1, static_cast<int>((value - range.least) / width));
    series.y[static_cast<std::size_t>(bin)] += 1;
  }
  return series;
}

std::string svg(const Plot& plot) {
  const Frame frame(plot);
  std::string out = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:g} {1:g}' width='{0:g}pt' height='{1:g}pt' "
      "font-family='Helvetica, Arial, sans-serif' font-size='{2:g}' role='img' aria-label='{3}'>\n"
      "<rect width='100%' height='100%' fill='white'/>\n",
      plot.width, plot.height, font_size, escaped(plot.title));
  out += axes(plot, frame);
  // pictures of one page share their identifiers: equal sizes have equal clips
  const std::string clip = fmt::format("clip-{:g}-{:g}", plot.width, plot.height);
  out += fmt::format(
      "<clipPath id='{}'><rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}'/></clipPath>\n", clip,
      margin_left, margin_top, frame.width(), frame.height());
  out += fmt::format("<g clip-path='url(#{})'>\n", clip);
  for (const Series& series : plot.series) out += drawn(series, plot, frame);
  for (const Marker& marker : plot.markers) out += drawn(marker, frame);
  return out + "</g>\n" + legend(plot, frame) + "</svg>\n";
}

}  // namespace egocal::tools
