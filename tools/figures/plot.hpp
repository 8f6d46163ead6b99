// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "figures/thinning.hpp"

namespace egocal::tools {

/// Colours that people with colour-blindness distinguish (Okabe and Ito), of falling contrast in grey.
enum class Colour { black, blue, vermilion, green, orange, sky, purple };
std::string hex(Colour colour);

enum class AxisScale { linear, logarithmic };

struct Axis {
  std::string label;  ///< with its unit: "translation error [m]"
  AxisScale scale = AxisScale::linear;
  std::optional<double> least, most;  ///< empty: from the data
};

/// Points in the order given. Points that are not finite, or not positive on a logarithmic axis, interrupt a
/// line.
struct Series {
  enum class Style { line, dashes, dotted, points, rings, bars };  ///< distinct in grey
  std::string name;                                                ///< for the legend; empty: not listed
  std::vector<double> x, y;
  Style style = Style::line;
  Colour colour = Colour::blue;
  std::vector<double> low, high;  ///< a band around y; empty or as long as y
  double radius = 1.3;            ///< of points [pt]
};

/// A vertical or horizontal line across the plot.
struct Marker {
  bool vertical = true;
  double at = 0;
  std::string label;
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  std::vector<Marker> markers;
  bool equal_axes = false;  ///< one unit of x is as long as one of y: maps
  double width = 252;       ///< [pt]; 252 pt = 3.5 inch, a column of the paper
  double height = 170;      ///< [pt]
  Thinning thinning;        ///< of long curves: of lines and filled dots
};

/// A complete <svg> element, with the data's own ranges, ticks at 1, 2 or 5 times a power of ten, and a
/// legend. The same plot gives the same bytes. Text is escaped.
std::string svg(const Plot& plot);

/// Ticks within [least, most] at 1, 2 or 5 times a power of ten, about as many as wanted.
std::vector<double> linear_ticks(double least, double most, int wanted);

/// A histogram as a series of bars: x the middle of each bin, y the count.
Series histogram(const std::vector<double>& values, int bins, Colour colour);

/// Text for XML: & < > and quotes escaped, control characters replaced.
std::string escaped(const std::string& text);

}  // namespace egocal::tools
