// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/online.hpp"
#include "egocal/problem/blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numbers>

namespace egocal::tools {

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
    const auto begin = std::chrono::steady_clock::now();
    blocks.add(pairs[i]);
    problem.blocks = blocks.inliers();
    const OnlineStep step = algorithm1_step(problem, pairs[i].end_us, state, options);
    const auto end = std::chrono::steady_clock::now();
    state = step.state;

    OnlinePoint point;
    point.frame = static_cast<int>(i) + 1;
    point.time = static_cast<double>(pairs[i].end_us - pairs.front().begin_us) * 1e-6;
    if (data.truth) point.error = extrinsic_error(*data.truth, step.answer.T_a_b);
    point.scaled_gap = step.answer.certificate.scaled_gap;
    point.certified = step.answer.certificate.optimality == Optimality::certified;
    point.fast_verified = step.fast_verified;
    point.global_used = step.global_used;
    point.microseconds = std::chrono::duration<double, std::micro>(end - begin).count();
    points.push_back(point);
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(count));
  }
  return points;
}

std::string csv(const std::vector<OnlinePoint>& points) {
  constexpr double degrees = 180 / std::numbers::pi;
  std::string text =
      "frame,time_s,translation_m,rotation_deg,scaled_gap,certified,fast_verified,global_used,step_us\n";
  for (const OnlinePoint& p : points) {
    const std::string error =
        p.error ? fmt::format("{:.9g},{:.9g}", p.error->translation, degrees * p.error->rotation) : ",";
    text += fmt::format("{},{:.6f},{},{:.6g},{:d},{:d},{:d},{:.2f}\n", p.frame, p.time, error, p.scaled_gap,
                        p.certified, p.fast_verified, p.global_used, p.microseconds);
  }
  return text;
}

std::string plot(const std::vector<OnlinePoint>& points, const std::string& csv_file,
                 const std::string& png_file) {
  std::string script = fmt::format(
      "set terminal pngcairo size 900,1000\nset output '{}'\nset datafile separator ','\nset grid\nset "
      "logscale y\n"
      "set multiplot layout 4,1\nunset key\nset xlabel 'frame'\n",
      png_file);
  const bool errors = !points.empty() && points.front().error;
  const auto panel = [&](const char* label, const char* column) {
    script += fmt::format("set ylabel '{}'\nplot '{}' using 1:{} with lines\n", label, csv_file, column);
  };
  if (errors) {
    panel("rotation error [deg]", "4");
    panel("translation error [m]", "3");
  }
  // the threshold of the certificate is one rounding
  script += fmt::format(
      "set ylabel 'gap / rounding'\nplot '{}' using 1:($5 > 1e-3 ? $5 : 1e-3) with lines, 1 dashtype 2\n",
      csv_file);
  panel("step [us]", "9");
  return script + "unset multiplot\n";
}

}  // namespace egocal::tools
