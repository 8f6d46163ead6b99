// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "report/pictures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "egocal/degrees.hpp"
#include "egocal/directions.hpp"
#include "figures/plot.hpp"
#include "report/series.hpp"

namespace egocal::tools {

namespace {

constexpr const char* time_axis = "time [s]";
constexpr const char* time_without_breaks = "time without breaks [s]";
constexpr Colour axis_colours[] = {Colour::blue, Colour::vermilion, Colour::green};  // of x, y, z

/// Labels the time axis, and marks with a line where a break is omitted.
void set_time_axis(const DrawnTime& time, Plot& plot) {
  plot.x.label = time.breaks().empty() ? time_axis : time_without_breaks;
  for (const double at : time.breaks()) plot.markers.push_back({true, at, ""});
}

Plot map_plot(const Map& map) {
  Plot plot;
  plot.title = "Path of sensor a, measured by a and by b";
  plot.x.label = "along the path's widest direction [m]";
  plot.y.label = "across [m]";
  plot.equal_axes = true;
  plot.height = 230;
  Series a, b;
  a.name = "by a";
  a.x = map.a_x;
  a.y = map.a_y;
  b.name = "by b, through T_a_b";
  b.x = map.b_x;
  b.y = map.b_y;
  b.style = Series::Style::dashes;
  b.colour = Colour::vermilion;
  plot.series = {a, b};
  return plot;
}

Plot over_time(const std::string& title, const std::string& unit, const DrawnTime& time,
               const std::vector<double>& seconds, const std::vector<double>& values, Colour colour) {
  Plot plot;
  plot.title = title;
  set_time_axis(time, plot);
  plot.y.label = unit;
  plot.y.least = 0;
  Series series;
  series.x = seconds;
  series.y = values;
  series.style = Series::Style::points;
  series.colour = colour;
  plot.series = {series};
  return plot;
}

Plot histogram_plot(const std::string& title, const std::string& unit, const std::vector<double>& values,
                    Colour colour) {
  Plot plot;
  plot.title = title;
  plot.x.label = unit;
  plot.y.label = "motions";
  plot.y.least = 0;
  plot.series = {histogram(values, 40, colour)};
  return plot;
}

Plot progress_plot(const Progress& progress, const DrawnTime& time, bool rotation) {
  Plot plot;
  plot.title = rotation ? "Standard deviation of the rotation" : "Standard deviation of the translation";
  set_time_axis(time, plot);
  plot.y.label = rotation ? "[deg]" : "[cm]";
  plot.y.scale = AxisScale::logarithmic;
  constexpr Series::Style styles[] = {Series::Style::line, Series::Style::dashes, Series::Style::line};
  for (std::size_t i = 0; i < 3; ++i) {
    Series series;
    series.name = direction_names[i + (rotation ? 3 : 0)];
    series.x = progress.time;
    for (const double stddev : progress.stddev[i + (rotation ? 3 : 0)])
      series.y.push_back(stddev * (rotation ? degrees_per_radian : 100));
    series.colour = axis_colours[i];
    series.style = styles[i];
    plot.series.push_back(series);
  }
  return plot;
}

Plot excitation_plot(const Excitation& excitation, const DrawnTime& time) {
  Plot plot;
  plot.title = "Turning of sensor a about its own axes";
  set_time_axis(time, plot);
  plot.y.label = "[deg/s]";
  for (std::size_t i = 0; i < 3; ++i) {
    Series series;
    series.name = fmt::format("{} (rms {:.2g})", direction_names[i], excitation.root_mean_square[i]);
    series.x = excitation.time;
    series.y = excitation.turning[i];
    series.colour = axis_colours[i];
    plot.series.push_back(series);
  }
  return plot;
}

/// Residual of the target's position of each sample over its row in the file.
Plot samples_plot(const SamplesOfPage& samples) {
  Plot plot;
  plot.title = "Position residuals of samples";
  plot.x.label = "row of the file";
  plot.y.label = "[mm]";
  plot.y.scale = AxisScale::logarithmic;  // a wrong sample is a hundred times further off than the others
  Series used, wrong;
  used.style = Series::Style::points;
  wrong.style = Series::Style::rings;
  wrong.colour = Colour::vermilion;
  wrong.radius = used.radius = 2;
  for (std::size_t i = 0; i < samples.residuals.size(); ++i) {
    Series& series = samples.residuals[i].wrong ? wrong : used;
    series.x.push_back(static_cast<double>(samples.rows[i] + 1));
    series.y.push_back(1e3 * samples.residuals[i].translation);
  }
  used.name = "used";
  wrong.name = "wrong, not used";
  plot.series = {used};
  if (!wrong.x.empty()) plot.series.push_back(wrong);
  return plot;
}

/// Whether a plot shows something: bars, or values that can be drawn at two places along the axis.
bool shows_something(const Plot& plot) {
  for (const Series& series : plot.series) {
    if (series.style == Series::Style::bars && !series.x.empty()) return true;
    std::optional<double> first;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const bool drawn = std::isfinite(series.x[i]) && std::isfinite(series.y[i]) &&
                         (plot.y.scale == AxisScale::linear || series.y[i] > 0);
      if (!drawn) continue;
      if (first && series.x[i] != *first) return true;
      first = series.x[i];
    }
  }
  return false;
}

/// The plots that show something, and one line that names the others.
std::string figures(const std::vector<Plot>& plots, const char* why) {
  std::string drawn;
  std::vector<std::string> omitted;
  for (const Plot& plot : plots)
    if (shows_something(plot))
      drawn += "<figure>" + svg(plot) + "</figure>\n";
    else
      omitted.push_back(plot.title + (plot.x.label.starts_with("time") ? " over time" : ""));
  std::string out;
  if (!drawn.empty()) out += "<div class='figures'>\n" + drawn + "</div>\n";
  if (!omitted.empty())
    out += "<p class='note'>No figure of: " + escaped(fmt::format("{}", fmt::join(omitted, ", "))) + ". " +
           why + "</p>\n";
  return out;
}

void add_residuals(const ReportInput& input, const DrawnTime& time, const std::string& motions,
                   std::vector<Plot>& plots) {
  const Residuals residuals = residuals_of(input.pairs, input.calibration.T_a_b, time);
  const std::string rotation = "Rotation residuals of " + motions;
  const std::string translation = "Translation residuals of " + motions;
  plots.push_back(over_time(rotation, "[deg]", time, residuals.time, residuals.rotation, Colour::blue));
  plots.push_back(histogram_plot(rotation, "[deg]", residuals.rotation, Colour::blue));
  plots.push_back(
      over_time(translation, "[m]", time, residuals.time, residuals.translation, Colour::vermilion));
  plots.push_back(histogram_plot(translation, "[m]", residuals.translation, Colour::vermilion));
}

void add_progress(const ReportInput& input, const DrawnTime& time, std::vector<Plot>& plots) {
  constexpr int points = 40;  // of a drawn curve
  const Progress progress = progress_of(input.a, input.b, input.options, points, time);
  plots.push_back(progress_plot(progress, time, false));
  plots.push_back(progress_plot(progress, time, true));
  plots.push_back(excitation_plot(excitation_of(input.a, time), time));
}

}  // namespace

std::string pictures(const ReportInput& input) {
  if (input.samples) return figures({samples_plot(*input.samples)}, "There are too few samples.");
  const double seconds = input.calibration.fit.motion_seconds;
  const std::string motions = seconds > 0 ? fmt::format("motions of {:.2g} s", seconds) : "motions";
  const DrawnTime time(input.a, input.pairs.empty() ? 0 : input.pairs.front().end_us);
  std::vector<Plot> plots;
  if (!input.a.empty()) plots.push_back(map_plot(map_of(input.a, input.b, input.calibration.T_a_b, time)));
  add_residuals(input, time, motions, plots);
  if (!input.a.empty()) add_progress(input, time, plots);
  std::string note;
  if (!input.pairs.empty())
    note = "<p class='note'>Residuals are those of the " + motions +
           " that the fit is stated of; none is rejected.</p>\n";
  if (!time.breaks().empty())
    note +=
        "<p class='note'>A dashed line is a break between drives or within a recording, which is "
        "omitted.</p>\n";
  return note + figures(plots, input.a.empty() ? "The motion pairs have no times of their own."
                                               : "The drive is too short.");
}

}  // namespace egocal::tools
