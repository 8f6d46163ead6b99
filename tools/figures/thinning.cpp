// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "figures/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>

namespace egocal::tools {

namespace {

/// First, lowest, highest and last point of each column, in the order of the line.
std::vector<Point> by_columns(const std::vector<Point>& line, double width) {
  std::vector<Point> kept;
  const auto column_of = [&](std::size_t i) { return std::floor(line[i].x / width); };
  for (std::size_t begin = 0, end = 0; begin < line.size(); begin = end) {
    std::size_t low = begin, high = begin;
    for (end = begin + 1; end < line.size() && column_of(end) == column_of(begin); ++end) {
      if (line[end].y < line[low].y) low = end;
      if (line[end].y > line[high].y) high = end;
    }
    std::size_t last = std::numeric_limits<std::size_t>::max();
    for (const std::size_t i : {begin, std::min(low, high), std::max(low, high), end - 1}) {
      if (i != last) kept.push_back(line[i]);
      last = i;
    }
  }
  return kept;
}

/// Goes along the line as long as one segment from the last point that was kept passes all others within the
/// tolerance, and keeps the point before that ends.
std::vector<Point> within_tolerance(const std::vector<Point>& line, double tolerance) {
  std::vector<Point> kept{line.front()};
  double furthest = 0, middle = 0, low = 0, high = 0;  // directions from the last point kept: [low, high]
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double x = line[i].x - kept.back().x, y = line[i].y - kept.back().y;
    const double distance = std::hypot(x, y);
    const bool turns_back = distance < furthest - tolerance;
    if (distance <= tolerance && !turns_back) continue;
    if (furthest == 0) {
      middle = std::atan2(y, x);
      low = -std::numbers::pi;
      high = std::numbers::pi;
    }
    const double direction = std::remainder(std::atan2(y, x) - middle, 2 * std::numbers::pi);
    if (turns_back || direction < low || direction > high) {
      kept.push_back(line[i - 1]);
      furthest = 0;
      --i;  // once more, from there
      continue;
    }
    const double half = std::asin(std::min(1.0, tolerance / distance));
    low = std::max(low, direction - half);
    high = std::min(high, direction + half);
    furthest = std::max(furthest, distance);
  }
  kept.push_back(line.back());
  return kept;
}

/// A step through n numbers that meets each once, and spreads those met so far evenly: of the golden ratio.
std::size_t spreading_step(std::size_t n) {
  auto step = static_cast<std::size_t>((std::numbers::phi - 1) * static_cast<double>(n));
  while (std::gcd(step, n) != 1) ++step;
  return step;
}

}  // namespace

std::vector<Point> thinned_line(const std::vector<Point>& line, const Thinning& thinning) {
  if (line.size() < thinning.least_points) return line;
  const auto by_x = [](const Point& p, const Point& q) { return p.x < q.x; };
  if (std::is_sorted(line.begin(), line.end(), by_x)) return by_columns(line, thinning.column);
  double tolerance = thinning.tolerance;
  std::vector<Point> kept = within_tolerance(line, tolerance);
  while (kept.size() > thinning.most_points) kept = within_tolerance(line, tolerance *= 2);
  return kept;
}

std::vector<Point> thinned_dots(const std::vector<Point>& dots, double radius, const Thinning& thinning) {
  if (dots.size() < thinning.least_points) return dots;
  const auto cell_of = [&](double at) { return static_cast<std::ptrdiff_t>(std::floor(at / thinning.cell)); };
  std::ptrdiff_t first_column = 0, last_column = 0, first_row = 0, last_row = 0;
  for (const Point& dot : dots) {
    first_column = std::min(first_column, cell_of(dot.x - radius));
    last_column = std::max(last_column, cell_of(dot.x + radius));
    first_row = std::min(first_row, cell_of(dot.y - radius));
    last_row = std::max(last_row, cell_of(dot.y + radius));
  }
  const std::ptrdiff_t columns = last_column - first_column + 1;
  std::vector<bool> covered(static_cast<std::size_t>(columns * (last_row - first_row + 1)));
  // a cell counts where all of it is inside of a dot: no gaps are left between dots
  const double inside = std::max(0.0, radius - thinning.cell * std::numbers::sqrt2 / 2);
  // from left to right each dot would add its right edge to what is covered, ten times as many
  std::vector<bool> seen(dots.size());
  const std::size_t step = spreading_step(dots.size());
  for (std::size_t turn = 0, i = 0; turn < dots.size(); ++turn, i = (i + step) % dots.size()) {
    const Point& dot = dots[i];
    for (std::ptrdiff_t row = cell_of(dot.y - radius); row <= cell_of(dot.y + radius); ++row)
      for (std::ptrdiff_t column = cell_of(dot.x - radius); column <= cell_of(dot.x + radius); ++column) {
        const double x = (static_cast<double>(column) + 0.5) * thinning.cell - dot.x,
                     y = (static_cast<double>(row) + 0.5) * thinning.cell - dot.y;
        if (x * x + y * y > inside * inside) continue;
        const auto cell = static_cast<std::size_t>((row - first_row) * columns + column - first_column);
        seen[i] = seen[i] || !covered[cell];
        covered[cell] = true;
      }
  }
  std::vector<Point> kept;
  for (std::size_t i = 0; i < dots.size(); ++i)
    if (seen[i]) kept.push_back(dots[i]);
  return kept;
}

}  // namespace egocal::tools
