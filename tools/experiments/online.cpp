// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/online.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "egocal/certificate/certificate.hpp"
#include "egocal/degrees.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/problem/blocks.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::tools {

namespace {

/// The solvers' times on one frame's problem: the fast one from the last answer, as in Algorithm 1.
void measure(const Problem& problem, const std::optional<DualQuaternion>& last, const OnlineOptions& options,
             OnlinePoint& point) {
  const auto now = [] {
    return static_cast<std::int64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                                     std::chrono::nanoseconds(1));
  };
  std::vector<double> fast, global, verified;
  constexpr int repeats = 5;  // of a measurement of time; the median counts
  for (int i = 0; i < repeats; ++i) {
    const Answer by_fast = solve(problem, options.fast, last, now);
    fast.push_back(1e-3 * static_cast<double>(by_fast.solve_ns));
    verified.push_back(1e-3 * static_cast<double>(by_fast.verify_ns));
    if (options.global)
      global.push_back(1e-3 *
                       static_cast<double>(solve(problem, *options.global, std::nullopt, now).solve_ns));
  }
  point.fast_us = median(fast);
  point.verify_us = median(verified);
  point.global_us = global.empty() ? 0 : median(global);
}

/// Scaled gap of any extrinsic on a problem.
double gap_at(const Problem& problem, const DualQuaternion& T_a_b) {
  const Matrix8d Q = cost_matrix(problem);
  if (problem.mode == Mode::spatial) return verify(Q, T_a_b).scaled_gap;
  return verify_planar(
             Q, planar_from_extrinsic(T_a_b, plane_frame(problem.plane_a), plane_frame(problem.plane_b)))
      .scaled_gap;
}

}  // namespace

std::vector<OnlinePoint> online_experiment(const DataSet& data, Mode mode, std::size_t frames,
                                           const OnlineOptions& options,
                                           const std::function<void(double)>& progress) {
  Problem problem = problem_of(data, mode, 0);
  const std::vector<MotionPair> pairs =
      mode == Mode::planar ? planar_motions(data.pairs, problem.plane_a, problem.plane_b) : data.pairs;
  const std::size_t count = std::min(frames, pairs.size());
  BlockStatistics blocks;
  OnlineState state;
  std::vector<OnlinePoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    blocks.add(pairs[i]);
    problem.blocks = blocks.inliers();
    const OnlineStep step = algorithm1_step(problem, pairs[i].end_us, state, options);
    OnlinePoint point;
    measure(problem, state.last, options, point);
    if (state.last) point.scaled_gap_before = gap_at(problem, *state.last);
    state = step.state;
    point.frame = static_cast<int>(i) + 1;
    point.time = to_seconds(pairs[i].end_us - pairs.front().begin_us);
    if (data.truth) point.error = extrinsic_error(*data.truth, step.answer.T_a_b);
    point.scaled_gap = step.fast_certificate.value_or(step.answer.certificate).scaled_gap;
    point.certified = step.answer.certificate.optimality == Optimality::certified;
    point.fast_verified = step.fast_verified;
    point.global_used = step.global_used;
    points.push_back(point);
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(count));
  }
  return points;
}

std::string csv(const std::vector<OnlinePoint>& points) {
  std::string text =
      "frame,time_s,translation_m,rotation_deg,scaled_gap,scaled_gap_before,certified,fast_verified,global_"
      "used,fast_us,global_us,verify_us\n";
  for (const OnlinePoint& p : points) {
    const std::string error =
        p.error ? fmt::format("{:.9g},{:.9g}", p.error->translation, degrees_per_radian * p.error->rotation)
                : ",";
    const std::string before = p.scaled_gap_before ? fmt::format("{:.6g}", *p.scaled_gap_before) : "";
    text += fmt::format("{},{:.6f},{},{:.6g},{},{:d},{:d},{:d},{:.2f},{:.2f},{:.2f}\n", p.frame, p.time,
                        error, p.scaled_gap, before, p.certified, p.fast_verified, p.global_used, p.fast_us,
                        p.global_us, p.verify_us);
  }
  return text;
}

int last_global_frame(const std::vector<OnlinePoint>& points) {
  int last = 0;
  for (const OnlinePoint& point : points)
    if (point.global_used) last = point.frame;
  return last;
}

std::vector<Panel> panels(const std::vector<OnlinePoint>& points) {
  const int last_global = last_global_frame(points);
  const auto plot_of = [&](const std::string& title, const std::string& unit) {
    Plot plot;
    plot.title = title;
    plot.x.label = "frame";
    plot.y = {unit, AxisScale::logarithmic, {}, {}};
    if (last_global > 0) plot.markers.push_back({true, last_global + 0.5, "fast alone"});
    return plot;
  };
  const auto series_of = [&](const std::string& name, Colour colour, Series::Style style, auto value) {
    Series series;
    series.name = name;
    series.colour = colour;
    series.style = style;
    for (const OnlinePoint& point : points) {
      series.x.push_back(point.frame);
      series.y.push_back(value(point));
    }
    return series;
  };
  std::vector<Panel> result;
  if (!points.empty() && points.front().error) {
    Plot rotation = plot_of("Rotation error", "rotation error [deg]"),
         translation = plot_of("Translation error", "translation error [m]");
    rotation.series.push_back(series_of("", Colour::blue, Series::Style::line, [&](const OnlinePoint& p) {
      return degrees_per_radian * p.error->rotation;
    }));
    translation.series.push_back(series_of("", Colour::blue, Series::Style::line,
                                           [](const OnlinePoint& p) { return p.error->translation; }));
    result.push_back({"rotation", rotation});
    result.push_back({"translation", translation});
  }
  Plot gap = plot_of("Duality gap of the fast solution", "gap / threshold");
  gap.markers.push_back({false, 1, "verified below"});
  gap.y.least = 0.01;
  double largest = 1;  // with room for the legend above the curves
  for (const OnlinePoint& p : points) largest = std::max(largest, p.scaled_gap_before.value_or(0));
  gap.y.most = 1e4 * largest;
  // a gap of zero has no place on a logarithmic axis
  const double least_gap = 0.01;
  gap.series.push_back(
      series_of("answer before", Colour::vermilion, Series::Style::dotted,
                [](const OnlinePoint& p) { return p.scaled_gap_before.value_or(std::nan("")); }));
  gap.series.push_back(
      series_of("fast solution", Colour::blue, Series::Style::line,
                [least_gap](const OnlinePoint& p) { return std::max(p.scaled_gap, least_gap); }));
  result.push_back({"gap", gap});
  Plot time = plot_of("Execution time", "execution time [us]");
  double longest = 0;  // with room for the label above the curves
  for (const OnlinePoint& p : points) longest = std::max({longest, p.fast_us, p.global_us, p.verify_us});
  if (longest > 0) time.y.most = 3 * longest;
  time.series.push_back(series_of("global", Colour::vermilion, Series::Style::dashes,
                                  [](const OnlinePoint& p) { return p.global_us; }));
  time.series.push_back(
      series_of("fast", Colour::blue, Series::Style::line, [](const OnlinePoint& p) { return p.fast_us; }));
  time.series.push_back(series_of("verification", Colour::green, Series::Style::dotted,
                                  [](const OnlinePoint& p) { return p.verify_us; }));
  result.push_back({"time", time});
  return result;
}

}  // namespace egocal::tools
