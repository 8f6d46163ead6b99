// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "report/html.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "degrees.hpp"
#include "egocal/directions.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/version.hpp"
#include "figures/plot.hpp"
#include "offline/common/backing_of.hpp"
#include "offline/printing/report.hpp"
#include "offline/printing/trust.hpp"
#include "report/series.hpp"

namespace egocal::tools {

namespace {

constexpr const char* style = R"(<style>
body { font: 15px/1.45 Helvetica, Arial, sans-serif; color: #1a1a1a; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; margin-bottom: 0; } h2 { font-size: 1.1rem; margin: 1.6rem 0 .4rem; border-bottom: 1px solid #bbb; }
.verdict { font-size: 1.2rem; font-weight: bold; padding: .6rem .8rem; border-left: .5rem solid #0072b2; background: #f2f2f2; }
.good { border-color: #009e73; }
.doubtful { border-color: #e69f00; background: #fdf3dc; }
.contradictory { border-color: #d55e00; background: #fbe6da; }
table { border-collapse: collapse; } td, th { padding: .15rem .8rem .15rem 0; text-align: left; vertical-align: top; }
td.number { font-variant-numeric: tabular-nums; text-align: right; } code, pre { font-size: .9rem; }
pre { overflow-x: auto; background: #f7f7f7; padding: .5rem; } .figures { display: flex; flex-wrap: wrap; gap: 1rem; }
figure { margin: 0; max-width: 100%; } svg { max-width: 100%; height: auto; } .note { color: #444; }
@media (max-width: 45rem) { .wide, .wide tbody, .wide tr, .wide th, .wide td { display: block; } .wide td { padding: 0 0 .5rem; } }
@media print { body { margin: 0; max-width: none; } h2 { break-after: avoid; } figure, table { break-inside: avoid; } }
</style>
)";

std::string row(const std::string& label, const std::string& value) {
  return fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escaped(label), value);
}

std::string section(const std::string& title, const std::string& content) {
  return fmt::format("<h2>{}</h2>\n{}", escaped(title), content);
}

std::string matrix_text(const Pose& T) {
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += fmt::format("{:12.9f} {:12.9f} {:12.9f} {:12.6f}\n", R(i, 0), R(i, 1), R(i, 2), T.translation[i]);
  return text + fmt::format("{:12} {:12} {:12} {:12}\n", 0, 0, 0, 1);
}

std::string transform(const std::string& title, const Pose& given, const std::string& unit) {
  const Pose T = with_positive_scalar(given);
  const Eigen::Vector3d& t = T.translation;
  const auto& q = T.rotation;
  const Eigen::Vector3d angles = roll_pitch_yaw(Eigen::Quaterniond(q)) * degrees;
  std::string table = "<table class='wide'>\n";
  table += row("translation x y z [" + unit + "]",
               fmt::format("<code>{:.6f} {:.6f} {:.6f}</code>", t.x(), t.y(), t.z()));
  table += row("quaternion w x y z",
               fmt::format("<code>{:.9f} {:.9f} {:.9f} {:.9f}</code>", q.w(), q.x(), q.y(), q.z()));
  table += row("quaternion x y z w",
               fmt::format("<code>{:.9f} {:.9f} {:.9f} {:.9f}</code>", q.x(), q.y(), q.z(), q.w()));
  table += row("roll pitch yaw [deg], R = Rz(yaw) Ry(pitch) Rx(roll)",
               fmt::format("<code>{:.5f} {:.5f} {:.5f}</code>", angles.x(), angles.y(), angles.z()));
  table += row("matrix", "<pre>" + matrix_text(T) + "</pre>");
  return "<h3>" + escaped(title) + "</h3>\n" + table + "</table>\n";
}

std::string optimality(const Certificate& certificate) {
  switch (certificate.optimality) {
    case Optimality::certified:
      return "optimal (proven): no extrinsic fits these motions better";
    case Optimality::not_optimal:
      return "not optimal: a better extrinsic is known";
    case Optimality::undecided:
      break;
  }
  return "undecided: too imprecise to prove or disprove";
}

std::string uncertainty(const Calibration& calibration) {
  std::string table =
      "<table>\n<tr><th>direction, in the frame of a</th><th>one standard deviation</th></tr>\n";
  const std::array<Backing, 6> backing = backing_of(calibration);
  for (std::size_t i = 0; i < 6; ++i) {
    const double stddev = calibration.observability.stddev[i];
    std::string value = "<b>not observable</b>: the number above is not a measurement";
    if (backing[i] == Backing::planes)
      value = "from the ground planes";
    else if (backing[i] == Backing::nominal)
      value = "<b>not observable</b>: from the nominal value";
    else if (calibration.observability.observable[i])
      value = std::isfinite(stddev)
                  ? fmt::format("&plusmn; {:.3f} {}", stddev * (i < 3 ? 100 : degrees), i < 3 ? "cm" : "deg")
                  : "observable, too few motions for a standard deviation";
    table += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", direction_names[i], value);
  }
  table += "</table>\n";
  if (!calibration.observability.hint.empty())
    table += "<p>" + escaped(calibration.observability.hint) + "</p>\n";
  return table +
         "<p class='note'>A standard deviation says how far the answer of another drive of this kind would "
         "be off. It "
         "does not contain what both drives would get wrong alike: systematic errors of the "
         "odometries.</p>\n";
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

Plot over_time(const std::string& title, const std::string& unit, const std::vector<double>& time,
               const std::vector<double>& values, Colour colour) {
  Plot plot;
  plot.title = title;
  plot.x.label = "time [s]";
  plot.y.label = unit;
  plot.y.least = 0;
  Series series;
  series.x = time;
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

Plot progress_plot(const Progress& progress, bool rotation) {
  Plot plot;
  plot.title = rotation ? "Standard deviation of the rotation" : "Standard deviation of the translation";
  plot.x.label = "time [s]";
  plot.y.label = rotation ? "[deg]" : "[cm]";
  plot.y.scale = AxisScale::logarithmic;
  constexpr Colour colours[] = {Colour::blue, Colour::vermilion, Colour::green};
  constexpr Series::Style styles[] = {Series::Style::line, Series::Style::dashes, Series::Style::line};
  for (std::size_t i = 0; i < 3; ++i) {
    Series series;
    series.name = direction_names[i + (rotation ? 3 : 0)];
    series.x = progress.time;
    for (const double stddev : progress.stddev[i + (rotation ? 3 : 0)])
      series.y.push_back(stddev * (rotation ? degrees : 100));
    series.colour = colours[i];
    series.style = styles[i];
    plot.series.push_back(series);
  }
  return plot;
}

Plot excitation_plot(const Excitation& excitation) {
  Plot plot;
  plot.title = "Turning of sensor a about its own axes";
  plot.x.label = "time [s]";
  plot.y.label = "[deg/s]";
  constexpr Colour colours[] = {Colour::blue, Colour::vermilion, Colour::green};
  for (std::size_t i = 0; i < 3; ++i) {
    Series series;
    series.name = fmt::format("{} (rms {:.2g})", direction_names[i], excitation.root_mean_square[i]);
    series.x = excitation.time;
    series.y = excitation.turning[i];
    series.colour = colours[i];
    plot.series.push_back(series);
  }
  return plot;
}

std::string figure(const Plot& plot) {
  return "<figure>" + svg(plot) + "</figure>\n";
}

std::string pictures(const ReportInput& input) {
  const Residuals residuals = residuals_of(input.pairs, input.calibration.T_a_b);
  const double seconds = input.calibration.fit.motion_seconds;
  const std::string motions = seconds > 0 ? fmt::format("motions of {:.2g} s", seconds) : "motions";
  std::string out = "<p class='note'>Residuals are those of the " + motions +
                    " that the fit is stated of; none is rejected.</p>\n<div class='figures'>\n";
  if (!input.a.empty()) out += figure(map_plot(map_of(input.a, input.b, input.calibration.T_a_b)));
  out += figure(over_time("Rotation residuals of " + motions, "[deg]", residuals.time, residuals.rotation,
                          Colour::blue));
  out +=
      figure(histogram_plot("Rotation residuals of " + motions, "[deg]", residuals.rotation, Colour::blue));
  out += figure(over_time("Translation residuals of " + motions, "[m]", residuals.time, residuals.translation,
                          Colour::vermilion));
  out += figure(
      histogram_plot("Translation residuals of " + motions, "[m]", residuals.translation, Colour::vermilion));
  if (!input.a.empty()) {
    constexpr int points = 40;  // of a drawn curve
    const Progress progress = progress_of(input.a, input.b, input.options, points);
    out += figure(progress_plot(progress, false)) + figure(progress_plot(progress, true));
    out += figure(excitation_plot(excitation_of(input.a)));
  }
  return out + "</div>\n";
}

std::string settings(const ReportInput& input) {
  const Calibration& calibration = input.calibration;
  std::string table = "<table class='wide'>\n";
  table += row("sensor a", "<code>" + escaped(input.name_a) + "</code>");
  table += row("sensor b", "<code>" + escaped(input.name_b) + "</code>");
  table += row("mode", calibration.problem.mode == Mode::planar ? "planar" : "three-dimensional");
  table += row("motions", escaped(motions_in_words(calibration)));
  table += row("poses", fmt::format("{} of a, {} of b, {} instants synchronised", calibration.counts.poses_a,
                                    calibration.counts.poses_b, calibration.counts.synchronised));
  table += row("not used", fmt::format("{} outliers, {}", calibration.counts.outliers,
                                       escaped(rejections_in_words(calibration.counts))));
  table += row("time offset", fmt::format("{:.4f} s added to b", calibration.time_offset_applied));
  if (calibration.time_offset)
    table += row("", fmt::format("estimated: &plusmn; {:.4f} s, correlation of the turning rates {:.2f}",
                                 calibration.time_offset->stddev, calibration.time_offset->correlation));
  const char* scaled = input.options.scale_side == Side::a ? "a" : "b";
  if (calibration.scale)
    table += row("scale", fmt::format("{:.6g} &plusmn; {:.6g} times the lengths of {}, estimated{}",
                                      calibration.scale->scale, calibration.scale->stddev, scaled,
                                      calibration.scale->certified ? " and proven" : ""));
  else if (calibration.scale_applied != 1)
    table += row("scale", fmt::format("{:.6g} times the lengths of {}", calibration.scale_applied, scaled));
  for (const std::string& warning : input.warnings) table += row("warning", escaped(warning));
  table += row("method", escaped(input.method));
  table += row("version", std::string("egocal ") + version());
  table += row("command", "<code>" + escaped(input.command) + "</code>");
  return table + "</table>\n";
}

}  // namespace

std::string report_html(const ReportInput& input) {
  const Calibration& calibration = input.calibration;
  const Certificate& certificate = calibration.certificate;
  std::string out =
      "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n<title>Calibration of " +
      escaped(input.name_b) + " in " + escaped(input.name_a) + "</title>\n" + style +
      "</head>\n<body>\n<h1>Extrinsic calibration</h1>\n<p class='note'>" + escaped(input.name_b) +
      " in the frame of " + escaped(input.name_a) + "</p>\n";
  const std::string word = input.verdict.substr(0, input.verdict.find(':'));
  out += "<p class='verdict " + escaped(word) + "'>" + escaped(input.verdict) + "</p>\n";
  for (const std::string& finding : input.findings) out += "<p>" + escaped(finding) + "</p>\n";
  if (const std::string fit = fit_in_words(calibration.fit); !fit.empty())
    out += "<p>Fit: " + escaped(fit) + ".</p>\n";
  if (input.unit != "m")
    out += "<p>Lengths are in the " + escaped(input.unit) +
           ", also where m or cm is written: metres only if that sensor measures metres.</p>\n";
  out += section("Transform", transform("T_a_b: pose of sensor b in sensor a, p_a = T_a_b p_b",
                                        calibration.T_a_b, input.unit) +
                                  transform("T_b_a: its inverse", calibration.T_b_a, input.unit));
  if (input.truth) {
    const ExtrinsicError error =
        extrinsic_error(to_dual_quaternion(*input.truth), to_dual_quaternion(calibration.T_a_b));
    out += fmt::format("<p>Against the given truth: {:.3f} deg, {:.2f} cm.</p>\n", error.rotation * degrees,
                       error.translation * 100);
  }
  out += section("Uncertainty", uncertainty(calibration));
  out +=
      section("Optimality",
              fmt::format("<p>{}. Cost {:.6g}, lower bound {:.6g}, gap {:.3g}.{}</p>\n",
                          optimality(certificate), certificate.cost, certificate.lower_bound, certificate.gap,
                          any_from_nominal(calibration) ? std::string(" ") + cost_with_nominal : ""));
  out += section("Fit and motion", pictures(input));
  out += section("How it was made", settings(input));
  return out + "</body>\n</html>\n";
}

}  // namespace egocal::tools
