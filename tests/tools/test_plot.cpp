// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Pictures of curves: ticks, values that cannot be drawn, thinning, histograms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "figures/plot.hpp"

namespace egocal::tools::test_plot {
namespace {

using ::testing::HasSubstr;

TEST(Plot, TicksAreRoundNumbersInsideTheRange) {
  EXPECT_THAT(linear_ticks(0, 10, 5), ::testing::ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(linear_ticks(-0.03, 0.021, 5),
              ::testing::Each(::testing::AllOf(::testing::Ge(-0.03), ::testing::Le(0.021))));
  EXPECT_TRUE(linear_ticks(1, 1, 5).empty());
  EXPECT_TRUE(linear_ticks(0, std::numeric_limits<double>::infinity(), 5).empty());
}

TEST(Plot, DrawsWhatCanBeDrawnAndEscapesText) {
  Plot plot;
  plot.title = "a < b & 'c'";
  plot.y.scale = AxisScale::logarithmic;
  Series series;
  series.name = "<script>";
  series.x = {1, 2, 3, 4, 5};
  series.y = {1, 10, 0, std::numeric_limits<double>::quiet_NaN(), 100};
  plot.series = {series};
  const std::string drawn = svg(plot);
  EXPECT_THAT(drawn, ::testing::Not(HasSubstr("<script>")));
  EXPECT_THAT(drawn, ::testing::Not(HasSubstr("nan")));
  EXPECT_THAT(drawn, HasSubstr("a &lt; b &amp; &#39;c&#39;"));
  // zero and NaN interrupt the line
  std::size_t lines = 0;
  for (std::size_t at = drawn.find("<polyline"); at != std::string::npos;
       at = drawn.find("<polyline", at + 1))
    ++lines;
  EXPECT_EQ(lines, 2u);
  EXPECT_EQ(drawn, svg(plot));
}

/// A million values of an odometry that turns, one of them a spike.
Series long_series(Series::Style style) {
  Series series;
  series.style = style;
  for (int i = 0; i < 1'000'000; ++i) {
    series.x.push_back(1e-3 * i);
    series.y.push_back(std::sin(1.7e-3 * i) + 0.3 * std::sin(2.9 * i));
  }
  series.y[777'777] = 9;
  return series;
}

/// Every pair of numbers in the picture's curve.
std::vector<Point> points_of(const std::string& drawn, const std::string& begin, char separator) {
  std::vector<Point> points;
  std::stringstream text(drawn.substr(drawn.find(begin) + begin.size()));
  Point point;
  for (char comma = 0; text >> point.x >> comma >> point.y;) {
    points.push_back(point);
    if (separator == 'M') text.ignore(3);  // h0M
  }
  return points;
}

TEST(Plot, LongCurvesAreThinnedToWhatAScreenShows) {
  for (const Series::Style style : {Series::Style::line, Series::Style::points}) {
    Plot plot;
    plot.series = {long_series(style)};
    const std::string drawn = svg(plot);
    EXPECT_LT(drawn.size(), 300'000u);
    EXPECT_EQ(drawn, svg(plot));
    // the spike is there, where it is in a picture of few points
    Plot few = plot;
    few.series[0].x = {0, 777.777, 999.999};
    few.series[0].y = {-1.3, 9, 1.3};
    few.y.least = plot.y.least = -1.6;
    few.y.most = plot.y.most = 9.4;
    few.thinning.least_points = 3;
    const bool line = style == Series::Style::line;
    const auto peak = [&](const Plot& one) {
      const std::vector<Point> points =
          points_of(svg(one), line ? "<polyline points='" : "<path d='M", line ? ' ' : 'M');
      return *std::min_element(points.begin(), points.end(),
                               [](const Point& p, const Point& q) { return p.y < q.y; });
    };
    EXPECT_NEAR(peak(plot).x, peak(few).x, 0.011);
    EXPECT_NEAR(peak(plot).y, peak(few).y, 0.011);
  }
}

TEST(Plot, ShortCurvesAreWrittenAsTheyAre) {
  std::vector<Point> line;
  for (int i = 0; i < 1999; ++i) line.push_back({0.01 * i, std::sin(i)});
  EXPECT_EQ(thinned_line(line, {}).size(), line.size());
  EXPECT_EQ(thinned_dots(line, 1.3, {}).size(), line.size());
}

// Each column of a line keeps its extremes and is entered and left where the line does
TEST(Plot, ColumnsKeepFirstLowestHighestAndLast) {
  std::vector<Point> line;
  for (int i = 0; i < 4000; ++i) line.push_back({1e-4 * i, i == 1234 ? 5.0 : i == 2000 ? -5.0 : 1e-3 * i});
  const std::vector<Point> kept = thinned_line(line, {});
  std::vector<double> at;
  for (const Point& point : kept) at.push_back(std::round(1e4 * point.x));
  EXPECT_THAT(at, ::testing::ElementsAre(0, 1234, 2000, 2499, 2500, 3999));
}

TEST(Plot, APathIsFollowedWithinTheTolerance) {
  std::vector<Point> path;
  for (int i = 0; i < 50'000; ++i)
    path.push_back(
        {100 + 60 * std::cos(1e-3 * i) + 20 * std::sin(2.3e-3 * i), 100 + 80 * std::sin(1.1e-3 * i)});
  path.insert(path.begin() + 25'000, {180, 30});  // there and back
  Thinning thinning;
  const std::vector<Point> kept = thinned_line(path, thinning);
  EXPECT_LT(kept.size(), 4000u);
  // every point is near a segment that is drawn
  std::size_t at = 0;
  double furthest = 0;
  for (const Point& point : path) {
    const auto distance = [&](std::size_t i) {
      const double x = kept[i + 1].x - kept[i].x, y = kept[i + 1].y - kept[i].y, length = x * x + y * y;
      const double t = ((point.x - kept[i].x) * x + (point.y - kept[i].y) * y) / length;
      const double s = length > 0 ? std::clamp(t, 0.0, 1.0) : 0;
      return std::hypot(point.x - kept[i].x - s * x, point.y - kept[i].y - s * y);
    };
    while (at + 2 < kept.size() && distance(at) > 2 * thinning.tolerance) ++at;
    furthest = std::max(furthest, distance(at));
  }
  EXPECT_LT(furthest, 2 * thinning.tolerance);
  std::vector<Point> scribble;
  for (int i = 0; i < 200'000; ++i)
    scribble.push_back({100 * std::abs(std::sin(1.3 * i)), 100 * std::abs(std::sin(2.7 * i * i))});
  EXPECT_LE(thinned_line(scribble, thinning).size(), thinning.most_points);
}

// What is drawn without a dot differs nowhere by as much as half a pixel
TEST(Plot, DotsAreLeftOutWhereOthersCoverThem) {
  std::vector<Point> dots;
  for (int i = 0; i < 300'000; ++i)
    dots.push_back({1e-3 * i, 50 + 40 * std::sin(0.7 * i) * std::sin(1.1 * i * i)});
  dots.push_back({150, 5});
  const std::vector<Point> kept = thinned_dots(dots, 1.3, {});
  EXPECT_LT(kept.size(), 25'000u);
  const auto covers = [](const std::vector<Point>& all, double x, double y, double radius) {
    return std::any_of(all.begin(), all.end(),
                       [&](const Point& dot) { return std::hypot(dot.x - x, dot.y - y) < radius; });
  };
  EXPECT_TRUE(covers(kept, 150, 5, 1e-9));
  for (int i = 0; i < 300; ++i) {
    const double x = 300 * std::abs(std::sin(3.3 * i)), y = 100 * std::abs(std::sin(1.9 * i));
    EXPECT_TRUE(!covers(dots, x, y, 1.3 - 0.25) || covers(kept, x, y, 1.3 + 0.25)) << x << " " << y;
  }
}

TEST(Plot, HistogramsCountEveryFiniteValueOnce) {
  const Series bars = histogram({0, 1, 1, 2, 10, std::numeric_limits<double>::quiet_NaN()}, 5, Colour::blue);
  double sum = 0;
  for (const double count : bars.y) sum += count;
  EXPECT_EQ(sum, 5);
  EXPECT_EQ(bars.y.front(), 3);
  EXPECT_TRUE(histogram({}, 5, Colour::blue).x.empty());
}

}  // namespace
}  // namespace egocal::tools::test_plot
