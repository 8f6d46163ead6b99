// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "figures/legend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "figures/elements.hpp"

namespace egocal::tools {

namespace {

constexpr double letter_width = 0.56 * font_size;  // of Helvetica, on average

/// A place for the legend: its upper left corner.
struct Place {
  double x = 0, y = 0;
};

/// Whether a legend there would hide the label of a vertical marker, which is at the top.
bool hides_a_label(const Plot& plot, const Frame& frame, const Place& corner, double width) {
  if (corner.y > margin_top + 2 * font_size) return false;
  for (const Marker& marker : plot.markers) {
    const double from = frame.x(marker.at),
                 to = from + letter_width * static_cast<double>(marker.label.size());
    if (marker.vertical && from < corner.x + width && to > corner.x) return true;
  }
  return false;
}

/// The corner that hides the fewest points of the data, and no label where that can be.
Place emptiest_corner(const Plot& plot, const Frame& frame, double width, double height) {
  constexpr double gap = 3;  // [pt]
  const double far_x = margin_left + frame.width() - width - gap,
               far_y = margin_top + frame.height() - height - gap;
  const Place corners[] = {{far_x, margin_top + gap},
                           {margin_left + gap, margin_top + gap},
                           {far_x, far_y},
                           {margin_left + gap, far_y}};
  Place best = corners[0];
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (const Place& corner : corners) {
    constexpr std::size_t label = 20;  // as bad as hiding this many points
    std::size_t hidden = hides_a_label(plot, frame, corner, width) ? label : 0;
    for (const Series& series : plot.series)
      for (std::size_t i = 0; i < series.x.size(); ++i) {
        if (!drawable(plot.x, series.x[i]) || !drawable(plot.y, series.y[i])) continue;
        const double x = frame.x(series.x[i]) - corner.x, y = frame.y(series.y[i]) - corner.y;
        hidden += x >= 0 && x <= width && y >= 0 && y <= height;
      }
    if (hidden >= fewest) continue;
    fewest = hidden;
    best = corner;
  }
  return best;
}

}  // namespace

std::string legend(const Plot& plot, const Frame& frame) {
  constexpr double line_height = font_size + 2, sample = 14;  // [pt]
  std::size_t rows = 0, longest = 0;
  for (const Series& series : plot.series) {
    rows += !series.name.empty();
    longest = std::max(longest, series.name.size());
  }
  if (rows == 0) return "";
  const double width = sample + 8 + letter_width * static_cast<double>(longest);
  const double height = line_height * static_cast<double>(rows) + 2;
  const Place place = emptiest_corner(plot, frame, width, height);
  std::string out = fmt::format(
      "<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' fill='white' fill-opacity='0.8'/>\n",
      place.x, place.y, width, height);
  double y = place.y + font_size;
  for (const Series& series : plot.series) {
    if (series.name.empty()) continue;
    const char* dashes = dashes_of(series);
    if (series.style == Series::Style::points || series.style == Series::Style::rings)
      out += circle(place.x + 2 + sample / 2, y - 3, std::max(2.0, series.radius), series);
    else
      out += fmt::format(
          "<line x1='{:.2f}' y1='{:.2f}' x2='{:.2f}' y2='{:.2f}' stroke='{}' stroke-width='2'{}/>\n",
          place.x + 2, y - 3, place.x + 2 + sample, y - 3, hex(series.colour), dashes);
    out += text_element(place.x + sample + 6, y, "start", series.name);
    y += line_height;
  }
  return out;
}

}  // namespace egocal::tools
