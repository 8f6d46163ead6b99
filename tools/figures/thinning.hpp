// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Long curves as a screen shows them: what cannot be seen is not written into a picture.
#pragma once

#include <cstddef>
#include <vector>

namespace egocal::tools {

/// A point in a picture [pt].
struct Point {
  double x = 0, y = 0;
};

/// How curves are thinned. Study: pages of long drives in Chromium, with all points and thinned
/// (tests/pages/run_report).
struct Thinning {
  std::size_t least_points = 2000;  ///< shorter curves are written as they are: about 100 kB
  /// A line over a growing x keeps first, lowest, highest and last point of each column of this width: a
  /// third of a pixel [pt].
  double column = 0.25;
  /// Any other line keeps what leaves it by more than this: a seventh of a pixel, a tenth of its width [pt].
  double tolerance = 0.1;
  /// A line that is still longer is drawn with twice the tolerance, and again: nothing but scribble is.
  std::size_t most_points = 20000;
  /// A dot is omitted if other dots cover all of its cells. Width of a cell: a third of a pixel [pt].
  double cell = 0.25;
};

/// What is left of a line.
std::vector<Point> thinned_line(const std::vector<Point>& line, const Thinning& thinning);

/// What is left of dots of one colour with this radius [pt].
std::vector<Point> thinned_dots(const std::vector<Point>& dots, double radius, const Thinning& thinning);

}  // namespace egocal::tools
