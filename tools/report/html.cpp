// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "report/html.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "egocal/degrees.hpp"
#include "egocal/directions.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/printable.hpp"
#include "egocal/version.hpp"
#include "figures/plot.hpp"
#include "offline/common/backing_of.hpp"
#include "offline/printing/decimals.hpp"
#include "offline/printing/report.hpp"
#include "report/pictures.hpp"
#include "report/trust_page.hpp"

namespace egocal::tools {

namespace {

constexpr const char* style = R"(<style>
body { font: 15px/1.45 Helvetica, Arial, sans-serif; color: #1a1a1a; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; margin-bottom: 0; } h2 { font-size: 1.1rem; margin: 1.6rem 0 .4rem; border-bottom: 1px solid #bbb; }
.verdict { font-size: 1.2rem; font-weight: bold; padding: .6rem .8rem; border-left: .5rem solid #0072b2; background: #f2f2f2; }
.good { border-color: #009e73; }
.doubtful { border-color: #e69f00; background: #fdf3dc; }
.contradictory { border-color: #d55e00; background: #fbe6da; }
.finding, .possible { padding-left: .8rem; border-left: .25rem solid #d55e00; } .possible { border-left: .25rem dotted #888; color: #444; }
table { border-collapse: collapse; } td, th { padding: .15rem .8rem .15rem 0; text-align: left; vertical-align: top; } td, code { overflow-wrap: anywhere; }
td.number { font-variant-numeric: tabular-nums; text-align: right; } code, pre { font-size: .9rem; }
pre { overflow-x: auto; background: #f7f7f7; padding: .5rem; } .figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(20rem, 100%), 1fr)); gap: 1rem; }
figure { margin: 0; max-width: 100%; } svg { width: 100%; height: auto; } .note { color: #444; }
@media (max-width: 45rem) { pre { font-size: min(.9rem, 2.8vw); } .wide, .wide tbody, .wide tr, .wide th, .wide td { display: block; } .wide td { padding: 0 0 .5rem; } }
@media print { body { margin: 0; max-width: none; } h2 { break-after: avoid; } figure, table { break-inside: avoid; } }
</style>
)";

/// What users name: a page is UTF-8 whatever a file's name is, and no name turns the text behind it round.
std::string named(const std::string& text) {
  constexpr std::size_t longest = 10'000;  // a limit [bytes]
  return escaped(printable(text, longest));
}

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

std::string transform(const std::string& title, const Pose& given, const std::string& unit,
                      const std::string& not_shown = {}) {
  Pose T = with_positive_scalar(given);
  T.translation = without_negative_zeros(T.translation, 6);
  const Eigen::Vector3d& t = T.translation;
  const auto& q = T.rotation;
  const Eigen::Vector3d angles =
      without_negative_zeros(roll_pitch_yaw(Eigen::Quaterniond(q)) * degrees_per_radian, 5);
  std::string table = "<table class='wide'>\n";
  if (!not_shown.empty()) table += row("of these numbers", "<b>" + escaped(not_shown) + "</b>");
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

std::string uncertainty(const Calibration& calibration, const char* frame) {
  std::string table = fmt::format(
      "<table>\n<tr><th>direction, in the frame of {}</th><th>one standard deviation</th></tr>\n", frame);
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
                  ? fmt::format("&plusmn; {:.3f} {}", stddev * (i < 3 ? 100 : degrees_per_radian),
                                i < 3 ? "cm" : "deg")
                  : "observable, too few motions for a standard deviation";
    table += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", direction_names[i], value);
  }
  table += "</table>\n";
  // more motion does not help where the motions contradict each other
  if (!calibration.observability.hint.empty() && calibration.verdict != Verdict::contradictory)
    table += "<p>" + escaped(calibration.observability.hint) + "</p>\n";
  return table +
         "<p class='note'>A standard deviation says how far the answer of another drive of this kind would "
         "be off. It does not contain what both drives would get wrong alike: systematic errors of the "
         "odometries.</p>\n";
}

std::string clock_rows(const ReportInput& input) {
  if (!input.clocks.empty())
    return row("time offset", "of each drive by itself<pre>" + escaped(input.clocks) + "</pre>");
  const Calibration& calibration = input.calibration;
  std::string table;
  table += row("time offset", fmt::format("{:.4f} s added to b", calibration.time_offset_applied));
  if (calibration.time_offset)
    table += row("", fmt::format("estimated: &plusmn; {:.4f} s, correlation of the turning rates {:.2f}",
                                 calibration.time_offset->stddev, calibration.time_offset->correlation));
  if (calibration.time_offset && calibration.time_offset->drifts)
    table += row("clock drift", fmt::format("{:.1f} &plusmn; {:.1f} us/s of b, corrected",
                                            1e6 * calibration.time_offset->rate,
                                            1e6 * calibration.time_offset->rate_stddev));
  return table;
}

/// What was made of streams or motion pairs; of still poses the section "Samples" says it.
std::string rows_of_motions(const ReportInput& input) {
  const Calibration& calibration = input.calibration;
  if (input.samples) return "";
  const bool streams = !input.a.empty();
  std::string table = row("motions", escaped(motions_in_words(calibration)));
  if (streams)
    table +=
        row("poses", fmt::format("{} of a, {} of b, {} instants synchronised", calibration.counts.poses_a,
                                 calibration.counts.poses_b, calibration.counts.synchronised));
  table += row("not used", fmt::format("{} outliers, {}", calibration.counts.outliers,
                                       escaped(rejections_in_words(calibration.counts))));
  return streams ? table + clock_rows(input) : table;
}

std::string settings(const ReportInput& input) {
  const Calibration& calibration = input.calibration;
  std::string table = "<table class='wide'>\n";
  table += row("sensor a", "<code>" + named(input.name_a) + "</code>");
  table += row("sensor b", "<code>" + named(input.name_b) + "</code>");
  table += row("mode", calibration.problem.mode == Mode::planar ? "planar" : "three-dimensional");
  table += rows_of_motions(input);
  const char* scaled = input.options.scale_side == Side::a ? "a" : "b";
  if (!input.scale_course.empty())
    table += row("scale", "changes along the drive; the extrinsic is one for all of it<pre>" +
                              escaped(input.scale_course) + "</pre>");
  else if (calibration.scale)
    table += row("scale", fmt::format("{:.6g} &plusmn; {:.6g} times the lengths of {}, estimated{}",
                                      calibration.scale->scale, calibration.scale->stddev, scaled,
                                      calibration.scale->certified ? " and proven" : ""));
  else if (calibration.scale_applied != 1)
    table += row("scale", fmt::format("{:.6g} times the lengths of {}", calibration.scale_applied, scaled));
  for (const std::string& warning : input.warnings) table += row("warning", named(warning));
  table += row("method", escaped(input.method));
  table += row("version", std::string("egocal ") + version());
  table += row("command", "<code>" + named(input.command) + "</code>");
  return table + "</table>\n";
}

}  // namespace

std::string report_html(const ReportInput& input) {
  const Calibration& calibration = input.calibration;
  const Certificate& certificate = calibration.certificate;
  std::string out =
      "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
      "<meta name='viewport' content='width=device-width'>\n<title>Calibration of " +
      named(input.name_b) + " in " + named(input.name_a) + "</title>\n" + style +
      "</head>\n<body>\n<h1>Extrinsic calibration</h1>\n<p class='note'>" + named(input.name_b) +
      " in the frame of " + named(input.name_a) + "</p>\n";
  const std::string word = input.verdict.substr(0, input.verdict.find(':'));
  out += "<p class='verdict " + escaped(word) + "'>" + escaped(input.verdict) + "</p>\n";
  out += trust_page(calibration);
  if (input.unit != "m")
    out += "<p>Lengths are in the " + escaped(input.unit) +
           ", also where m or cm is written: metres only if that sensor measures metres.</p>\n";
  if (input.samples) out += section("Samples", table_of_lines(input.samples->text));
  out += section("Transform", transform(frames_of_answer(input.eye_to_hand).title, calibration.T_a_b,
                                        input.unit, not_shown_in_words(calibration)) +
                                  transform("T_b_a: its inverse", calibration.T_b_a, input.unit));
  if (input.truth) {
    const ExtrinsicError error =
        extrinsic_error(to_dual_quaternion(*input.truth), to_dual_quaternion(calibration.T_a_b));
    out += fmt::format("<p>Against the given truth: {:.3f} deg, {:.2f} cm.</p>\n",
                       error.rotation * degrees_per_radian, error.translation * 100);
  }
  out += section("Uncertainty", uncertainty(calibration, frames_of_answer(input.eye_to_hand).frame));
  out += section("Optimality",
                 fmt::format("<p>{}. Cost {:.6g}, lower bound {:.6g}, gap {:.3g}. {}</p>\n",
                             optimality(certificate), certificate.cost, certificate.lower_bound,
                             certificate.gap, any_from_nominal(calibration) ? cost_with_nominal : ""));
  out += section(input.samples ? "Residuals" : "Fit and motion", pictures(input));
  out += section("How it was made", settings(input));
  return out + "</body>\n</html>\n";
}

}  // namespace egocal::tools
