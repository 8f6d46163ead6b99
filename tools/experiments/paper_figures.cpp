// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "egocal/degrees.hpp"
#include "egocal/simulation/simulation.hpp"
#include "experiments/globality.hpp"
#include "experiments/noise_slopes.hpp"
#include "experiments/noisy_drive.hpp"
#include "experiments/online.hpp"
#include "experiments/paper_parts.hpp"
#include "experiments/paper_values.hpp"

namespace egocal::tools {

namespace {

/// Positions of a path as it is drawn.
struct Drawn {
  std::vector<double> x, y;
};

Series series_of(const std::string& name, const Drawn& points, Colour colour, Series::Style style) {
  Series series;
  series.name = name;
  series.x = points.x;
  series.y = points.y;
  series.colour = colour;
  series.style = style;
  series.radius = 3;  // single places on a map
  return series;
}

Plot map(const std::string& title, const std::string& x, const std::string& y) {
  Plot plot;
  plot.title = title;
  plot.x.label = x;
  plot.y.label = y;
  plot.equal_axes = true;
  plot.height = 230;
  return plot;
}

/// Positions with the plane through them taken out: a path begins with the slope of its first metre.
std::vector<Eigen::Vector3d> levelled(const Trajectory& path) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> points;
  for (const StampedPose& pose : path) {
    points.emplace_back(to_pose(pose.pose).translation);
    const Eigen::Vector3d row(points.back().x(), points.back().y(), 1);
    normal += row * row.transpose();
    right += row * points.back().z();
  }
  const Eigen::Vector3d plane = normal.ldlt().solve(right);
  for (Eigen::Vector3d& p : points) p.z() -= plane.dot(Eigen::Vector3d(p.x(), p.y(), 1));
  return points;
}

/// Seen from the side and above: depth goes up and to the right.
Drawn oblique(const std::vector<Eigen::Vector3d>& points, double height_factor) {
  constexpr double slant = 0.5;  // of the drawing
  Drawn drawn;
  for (const Eigen::Vector3d& p : points) {
    drawn.x.push_back(p.x() + slant * p.y());
    drawn.y.push_back(slant * p.y() + height_factor * p.z());
  }
  return drawn;
}

}  // namespace

std::string figures_html(const std::vector<Panel>& panels) {
  std::string text = "<div class='figures'>\n";
  for (const Panel& panel : panels) text += "<figure>" + svg(panel.plot) + "</figure>\n";
  return text + "</div>\n";
}

std::string figure_3_part(const PaperOptions& options, const PaperData&, const PartProgress&) {
  const NoiseOptions drive;
  SimulationOptions simulation;
  simulation.poses = 501;
  simulation.speed = drive.step * simulation.rate;
  simulation.roughness = drive.roughness;
  const std::vector<Eigen::Vector3d> path = levelled(simulate(simulation).front());
  Drawn flat;
  std::string csv = "x_m,y_m,z_m\n";
  for (const Eigen::Vector3d& p : path) {
    flat.x.push_back(p.x());
    flat.y.push_back(p.y());
    csv += fmt::format("{:.6f},{:.6f},{:.6f}\n", p.x(), p.y(), p.z());
  }
  Plot above = map("(a) path on the ground", "x [m]", "y [m]");
  above.series = {series_of("", flat, Colour::blue, Series::Style::line)};
  constexpr double exaggeration = 3;  // of the drawing
  Plot oblique_view = map("(b) path on the surface", "x, and y at an angle [m]", "");
  oblique_view.series = {series_of("on the ground", oblique(path, 0), Colour::orange, Series::Style::dashes),
                         series_of(fmt::format("on the surface, height x {:g}", exaggeration),
                                   oblique(path, exaggeration), Colour::blue, Series::Style::line)};
  const std::vector<Panel> panels{{"ground", above}, {"surface", oblique_view}};
  write_figure(options.out, "fig-3", csv, panels);
  return "<p>A path as V-A describes it: a two-dimensional path, projected on a mixture of sinusoids; that "
         "of Fig. 4.</p>\n" +
         figures_html(panels);
}

std::string figure_4_part(const PaperOptions& options, const PaperData&, const PartProgress& progress) {
  NoiseOptions noise;
  noise.even_sizes = true;
  noise.mixed = true;
  noise.sensors = options.full ? paper::sensor_pairs : 4;
  noise.sizes = options.full ? paper::sizes : 60;
  noise.repeats = options.full ? paper::runs : 8;
  const std::vector<NoisePoint> points = noise_experiment(noise, progress);
  const std::vector<Panel> drawn = panels(points);
  write_figure(options.out, "fig-4", csv(points), drawn);
  long long runs = 0, certified = 0;
  double seconds = 0;
  for (const NoisePoint& point : points) {
    runs += point.runs;
    certified += point.certified;
    seconds += point.solve_seconds;
  }
  const NoisyDrive drive({noise.most_pairs, noise.step, noise.roughness, noise.seed}, Pose{});
  std::string text = fmt::format(
      "<p>From pose to pose {:.2f} m and {:.3f} rad on average; the paper's example in V-A has 1 m and 0.1 "
      "rad.</p>\n",
      drive.mean_translation(), drive.mean_rotation());
  text += fmt::format(
      "<p>{} optimisations ({} noise levels, {} sizes, {} pairs of sensors 2 to 8 m apart, {} runs), {} "
      "certified, {:.2f} s of solving and proving. The paper: {} optimisations ({} x {} x {} x {}); {} ms "
      "each would be {:.1f} hours.</p>\n",
      runs, noise.levels.size(), noise.sizes, noise.sensors, noise.repeats, certified, seconds,
      paper::optimisations, paper::noise_levels, paper::sizes, paper::sensor_pairs, paper::runs,
      paper::table_1[3].milliseconds, paper::optimisations * paper::table_1[3].milliseconds / 3.6e6);
  const std::vector<NoiseSlope> fall = slopes(points);
  return text + figures_html(drawn) + html(fall) +
         fmt::format(
             "<p>Mean of the exponents of all runs for n &gt; 100, with its standard error; independent "
             "noise gives n<sup>-0.5</sup>. The spread is the error without what the runs of one sensor pose "
             "share. That is a bias: the motions of both sensors are noisy, and least squares then finds a "
             "lever arm that is too short, at {:g} % noise by {:.1f} %, however many motions there are. "
             "Bands: quartiles.</p>\n",
             100 * fall.back().level, 100 * fall.back().shortened);
}

std::string figure_5_part(const PaperOptions& options, const PaperData& data, const PartProgress&) {
  constexpr std::size_t most = 1000;  // points of the drawing
  // the two directions in which the drive extends most: a camera's y points down
  Eigen::Vector3d least = Eigen::Vector3d::Constant(1e300), largest = -least;
  for (const StampedPose& pose : data.path) {
    least = least.cwiseMin(to_pose(pose.pose).translation);
    largest = largest.cwiseMax(to_pose(pose.pose).translation);
  }
  Eigen::Index up = 0;
  (largest - least).minCoeff(&up);
  const Eigen::Index across = up == 0 ? 1 : 0, along = up == 2 ? 1 : 2;
  Drawn path, first, later;
  std::string csv = "frame,across_m,along_m\n";
  for (std::size_t i = 0; i < std::min(most, data.path.size()); ++i) {
    const Eigen::Vector3d p = to_pose(data.path[i].pose).translation;
    path.x.push_back(p[across]);
    path.y.push_back(p[along]);
    csv += fmt::format("{},{:.4f},{:.4f}\n", i, p[across], p[along]);
    Drawn* marked = i == 0 ? &first : i == paper::online_frames ? &later : nullptr;
    if (!marked) continue;
    marked->x.push_back(p[across]);
    marked->y.push_back(p[along]);
  }
  Plot plot = map("First frames of the drive", "across [m]", "along [m]");
  plot.series = {series_of("", path, Colour::blue, Series::Style::line),
                 series_of("first frame", first, Colour::green, Series::Style::rings),
                 series_of(fmt::format("frame {}", paper::online_frames), later, Colour::vermilion,
                           Series::Style::points)};
  const std::vector<Panel> panels{{"path", plot}};
  write_figure(options.out, "fig-5", csv, panels);
  return fmt::format("<p>{}, the first {} poses, as in the paper.</p>\n", escaped(data.online_name),
                     path.x.size()) +
         figures_html(panels);
}

std::string figure_6_part(const PaperOptions& options, const PaperData& data, const PartProgress& progress) {
  std::string text = fmt::format(
      "<p>{}, the first {} frames. The paper's green line (the fast solver alone from here) is at frame {}; "
      "its fast solver needs "
      "{:g} ms, a verification {:g} ms.</p>\n",
      escaped(data.online_name), paper::online_frames, paper::last_global_frame, paper::fast_online_ms,
      paper::verify_ms);
  const bool planar = data.online.plane_a.has_value();
  for (const Mode mode : {Mode::spatial, Mode::planar}) {
    if (mode == Mode::planar && !planar) continue;
    const char* name = mode == Mode::planar ? "fig-6-planar" : "fig-6-3d";
    const std::vector<OnlinePoint> points = online_experiment(
        data.online, mode, paper::online_frames, {},
        [&](double part) { progress((part + (mode == Mode::planar ? 1 : 0)) / (planar ? 2 : 1)); });
    const std::vector<Panel> drawn = panels(points);
    write_figure(options.out, name, csv(points), drawn);
    const std::vector<OnlinePoint> whole =
        online_experiment(data.online, mode, data.online.pairs.size(), {}, {});
    const std::vector<Panel> whole_drive = panels(whole);
    write_figure(options.out, std::string(name) + "-all", csv(whole), whole_drive);
    std::vector<double> fast, verify;
    int not_verified = 0;
    for (const OnlinePoint& point : points) {
      fast.push_back(1e-3 * point.fast_us);
      verify.push_back(1e-3 * point.verify_us);
      not_verified += !point.fast_verified;
    }
    const OnlinePoint& last = points.back();
    text += fmt::format(
        "<h3>{}</h3>\n<p>The global solver is asked for the last time in frame {}; the fast solution "
        "was not verified in {} of {} frames, after which the global solver is asked for {:g} s more. Fast "
        "solver {:.4f} ms, "
        "verification {:.4f} ms "
        "(medians){}.</p>\n",
        mode == Mode::planar ? "Planar" : "Three-dimensional", last_global_frame(points), not_verified,
        points.size(), OnlineOptions{}.t_no_fail, median(fast), median(verify),
        last.error ? fmt::format("; at frame {} {:.2f} cm, {:.3f} deg", last.frame,
                                 100 * last.error->translation, last.error->rotation * degrees_per_radian)
                   : std::string());
    text += figures_html(drawn);
    const OnlinePoint& end = whole.back();
    text += fmt::format(
                "<p>All {} frames: certified in {}{}.</p>\n", whole.size(),
                std::count_if(whole.begin(), whole.end(), [](const OnlinePoint& p) { return p.certified; }),
                end.error ? fmt::format("; at the end {:.2f} cm, {:.3f} deg", 100 * end.error->translation,
                                        end.error->rotation * degrees_per_radian)
                          : std::string()) +
            figures_html(whole_drive);
  }
  if (!planar) text += "<p>Planar: not without ground planes (--data).</p>\n";
  return text;
}

std::string globality_part(const PaperOptions& options, const PaperData& data, const PartProgress&) {
  GlobalityOptions globality;
  const std::vector<GlobalityPoint> points = globality_experiment(data.online, globality);
  const std::vector<Panel> drawn = panels(points);
  write_figure(options.out, "v-f", csv(points), drawn);
  // the smallest amount from which on every falsified optimum was disproved
  const auto found_from = [&](bool rotation) {
    double amount = 0;
    for (const GlobalityPoint& point : points)
      if (point.rotation == rotation && point.disproved < point.runs) amount = std::max(amount, point.amount);
    double from = std::numeric_limits<double>::infinity();
    for (const GlobalityPoint& point : points)
      if (point.rotation == rotation && point.amount > amount) from = std::min(from, point.amount);
    return from;
  };
  long long certified = 0, runs = 0;
  for (const GlobalityPoint& point : points) {
    certified += point.certified;
    runs += point.runs;
  }
  return fmt::format(
             "<p>{} falsified optima of {}, {} of them certified. Every one is disproved from {:g} deg and "
             "{:g} m on; the paper: "
             "\"reliably indicated\" at about {:g} deg or {:g} m. The curves of different numbers of frames "
             "lie on each other.</p>\n",
             runs, escaped(data.online_name), certified, found_from(true), found_from(false),
             paper::reliably_found_deg, paper::reliably_found_m) +
         figures_html(drawn);
}

}  // namespace egocal::tools
