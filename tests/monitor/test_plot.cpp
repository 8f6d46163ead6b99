// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

#include "egocal/monitor/plot.hpp"

namespace egocal::monitor::test_plot {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr int field_x = 9;  // columns before the field: numbers and axis

History course(double seconds, double step, const std::function<double(double)>& value) {
  History history;
  for (int i = 0; i * step <= seconds; ++i) {
    std::array<double, curve_count> values{};
    values.fill(value(i * step));
    history.add(i * step, values);
  }
  return history;
}

Plot plot_of(const History& history, double end) {
  Plot plot;
  plot.title = "error [cm]";
  plot.end = end;
  plot.series = {{&history, Style::fast}};
  return plot;
}

std::vector<std::string> drawn(const Plot& plot, int w, int h, Charset charset, Canvas* kept = nullptr) {
  Canvas canvas(w, h);
  draw_plot(Pane(canvas), plot, charset);
  if (kept) *kept = canvas;
  std::vector<std::string> lines;
  std::istringstream text(canvas.to_text());
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

// The row of a column's only star; -1: none.
int star(const std::vector<std::string>& lines, int column) {
  int row = -1;
  for (std::size_t y = 1; y + 1 < lines.size(); ++y)
    if (static_cast<int>(lines[y].size()) > field_x + column &&
        lines[y][static_cast<std::size_t>(field_x + column)] == '*') {
      EXPECT_EQ(row, -1);
      row = static_cast<int>(y);
    }
  return row;
}

}  // namespace

TEST(Plot, AxesCarryNumbersAndUnits) {
  const History history = course(20, 0.1, [](double t) { return std::pow(10, 2 - t / 5); });
  const auto lines = drawn(plot_of(history, 20), 60, 14, Charset::ascii);
  EXPECT_EQ(lines[0], " error [cm]");
  EXPECT_THAT(lines[1], HasSubstr("100 +"));
  EXPECT_THAT(lines[12], HasSubstr("0.0100 +"));
  EXPECT_THAT(lines[13], HasSubstr("+0---"));
  EXPECT_THAT(lines[13], HasSubstr("-10-"));
  EXPECT_THAT(lines[13], HasSubstr("-20 s"));
  int decades = 0;
  for (const std::string& line : lines)
    for (const char* label : {"100 +", "10.0 +", "1.00 +", "0.100 +", "0.0100 +"})
      if (line.find(label) != std::string::npos && line.find_first_not_of(' ') == line.find(label)) ++decades;
  EXPECT_EQ(decades, 5);
}

TEST(Plot, AnExponentialIsAStraightLineOnLogarithmicAxesAndNotOnLinearOnes) {
  const History history = course(20, 0.1, [](double t) { return std::pow(10, 2 - t / 5); });
  Plot plot = plot_of(history, 20);
  Canvas canvas(0, 0);
  const int w = 60, h = 23, columns = w - 10;
  auto lines = drawn(plot, w, h, Charset::ascii);
  const auto top_star = [&](int column) {
    for (std::size_t y = 1; y + 1 < lines.size(); ++y)
      if (static_cast<int>(lines[y].size()) > field_x + column &&
          lines[y][static_cast<std::size_t>(field_x + column)] == '*')
        return static_cast<int>(y);
    return -1;
  };
  const int rows = h - 2;
  for (int x = 0; x < columns; ++x)
    EXPECT_NEAR(top_star(x), 1 + (rows - 1) * x / static_cast<double>(columns), 1.5) << x;
  plot.logarithmic = false;
  lines = drawn(plot, w, h, Charset::ascii);
  EXPECT_GE(top_star(columns / 2), rows - 2) << "a hundredth of the beginning: at the bottom";
  EXPECT_THAT(lines[h - 2], HasSubstr(" 0 +"));
}

TEST(Plot, ValuesAreScaledToTheirUnit) {
  const History history = course(5, 0.1, [](double) { return 0.05; });
  Plot plot = plot_of(history, 5);
  plot.scale = 100;
  plot.logarithmic = false;
  const auto lines = drawn(plot, 50, 12, Charset::ascii);
  const int row = star(lines, 20);
  ASSERT_GE(row, 1);
  // the axis ends a twentieth of its range beyond the value
  EXPECT_THAT(lines[1] + lines[10], HasSubstr("5.0"));
}

TEST(Plot, LinearAxesHaveRoundNumbers) {
  for (const double size : {0.0037, 0.9, 11.0, 4321.0}) {
    const History history = course(10, 0.1, [&](double t) { return size * (0.1 + 0.09 * t); });
    Plot plot = plot_of(history, 10);
    plot.logarithmic = false;
    const auto lines = drawn(plot, 60, 14, Charset::ascii);
    std::vector<double> numbers;
    for (std::size_t y = 1; y + 1 < lines.size(); ++y)
      if (lines[y].size() > 8 && lines[y][8] == '+') numbers.push_back(std::stod(lines[y]));
    ASSERT_GE(numbers.size(), 3u) << size;
    EXPECT_EQ(numbers.back(), 0);
    EXPECT_GE(numbers.front(), 0.99 * size);
    const double step = numbers[numbers.size() - 2];
    const double digit = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-9 || std::abs(digit - 2) < 1e-9 || std::abs(digit - 5) < 1e-9)
        << step;
  }
}

TEST(Plot, ThresholdAcrossAndMarkDown) {
  const History history = course(10, 0.1, [](double) { return 0.01; });
  Plot plot = plot_of(history, 10);
  plot.threshold = 1.0;
  plot.mark = 5.0;
  plot.mark_label = "fast alone";
  for (const Charset charset : {Charset::ascii, Charset::unicode}) {
    Canvas canvas(0, 0);
    const auto lines = drawn(plot, 60, 12, charset, &canvas);
    EXPECT_THAT(lines[1], HasSubstr(charset == Charset::ascii ? "1.00 +---" : "1.00 ┤╌╌╌"))
        << "the threshold is on the axis though no value comes near";
    EXPECT_THAT(lines[0], HasSubstr("fast alone"));
    int dashes = 0, marks = 0;
    for (int x = field_x; x < 60; ++x) dashes += canvas.at(x, 1).style == Style::threshold;
    for (int y = 1; y < 11; ++y) marks += canvas.at(field_x + 24, y).style == Style::global;
    EXPECT_GE(dashes, 48);
    EXPECT_GE(marks, 9);
  }
  plot.mark = 50.0;  // not in view
  EXPECT_THAT(drawn(plot, 60, 12, Charset::ascii)[0], Not(HasSubstr("fast alone")));
}

TEST(Plot, BrailleDrawsTwoByFourDotsACell) {
  const History history = course(10, 0.05, [](double t) { return 1 + t; });
  Plot plot = plot_of(history, 10);
  plot.logarithmic = false;
  Canvas canvas(0, 0);
  drawn(plot, 40, 10, Charset::unicode, &canvas);
  int braille = 0, last = -1;
  for (int x = field_x; x < 39; ++x)
    for (int y = 1; y < 9; ++y) {
      const char32_t g = canvas.at(x, y).glyph;
      if (g < 0x2801 || g > 0x28ff) continue;
      ++braille;
      EXPECT_EQ(canvas.at(x, y).style, Style::fast);
      EXPECT_LE(y, last < 0 ? y : last + 1);
      last = y;
    }
  EXPECT_GE(braille, 30);
}

TEST(Plot, ASpikeIsSeenHoweverLongTheDrive) {
  const History history = course(4000, 0.1, [](double t) { return std::abs(t - 2000) < 0.04 ? 50.0 : 1.0; });
  const auto lines = drawn(plot_of(history, 4000), 60, 12, Charset::ascii);
  EXPECT_THAT(lines[1] + lines[2] + lines[3] + lines[4], HasSubstr("*"));
}

TEST(Plot, AGapStaysOpen) {
  History history;
  std::array<double, curve_count> values{};
  values.fill(1.0);
  for (int i = 0; i <= 1000; ++i)
    if (i < 300 || i > 700) history.add(i * 0.1, values);
  const auto lines = drawn(plot_of(history, 100), 60, 12, Charset::ascii);
  EXPECT_GE(star(lines, 5), 1);
  EXPECT_EQ(star(lines, 25), -1);
  EXPECT_GE(star(lines, 45), 1);
}

TEST(Plot, HostileValuesAndSizes) {
  const double evil[] = {
      not_a_number, std::numeric_limits<double>::infinity(), -1, 0, 1e308, 1e-308, -1e308, 5};
  int n = 0;
  const History history = course(50, 0.1, [&](double) { return evil[n++ % 8]; });
  const History nothing, none = course(5, 0.1, [](double) { return not_a_number; });
  for (const Charset charset : {Charset::ascii, Charset::unicode})
    for (bool logarithmic : {true, false})
      for (double end : {50.0, 0.0, -3.0, not_a_number, 1e300})
        for (int w = 0; w < 90; w += 3)
          for (int h = 0; h < 25; ++h) {
            Plot plot = plot_of(history, end);
            plot.series.push_back({&nothing, Style::global});
            plot.series.push_back({&none, Style::global});
            plot.logarithmic = logarithmic;
            plot.threshold = h % 2 ? not_a_number : 1.0;
            plot.mark = w % 2 ? not_a_number : 3.0;
            drawn(plot, w, h, charset);
          }
  const auto lines = drawn(plot_of(none, 5), 40, 10, Charset::ascii);
  EXPECT_THAT(lines[5], HasSubstr("no values yet"));
}

TEST(History, IsBoundedAndKeepsItsExtremes) {
  const History history = course(50000, 1, [](double t) { return t == 7 ? 99.0 : 1.0; });
  for (double back : {10.0, 50.0, 1000.0, 49000.0, 60000.0}) {
    const auto& slices = history.since(history.last_time() - back);
    EXPECT_LE(slices.size(), History::slices);
    EXPECT_LE(slices.front().begin, std::max(0.0, history.last_time() - back));
  }
  EXPECT_EQ(history.since(0).front().high[rotation_error], 99.0f);
  EXPECT_EQ(history.since(0).front().low[rotation_error], 1.0f);
}

}  // namespace egocal::monitor::test_plot
