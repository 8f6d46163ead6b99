// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/globality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "egocal/degrees.hpp"
#include "egocal/solvers/global.hpp"

namespace egocal::tools {

namespace {

/// Directions spread evenly over the sphere by the golden angle, turned by the seed.
Eigen::Vector3d direction(int index, int count, std::uint64_t seed) {
  const double z = 1 - (2.0 * index + 1) / count;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const double angle = golden * (index + static_cast<double>(seed % 1000));
  const double radius = std::sqrt(std::max(0.0, 1 - z * z));
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

}  // namespace

std::vector<GlobalityPoint> globality_experiment(const DataSet& data, const GlobalityOptions& options) {
  std::vector<GlobalityPoint> points;
  for (const double part : options.parts) {
    const std::size_t frames =
        std::max<std::size_t>(1, static_cast<std::size_t>(part * static_cast<double>(data.pairs.size())));
    const Matrix8d Q = cost_matrix(problem_of(data, Mode::spatial, frames));
    const Solution optimum = solve_dual(Q);
    const auto falsify = [&](bool rotation, double amount) {
      GlobalityPoint point;
      point.frames = frames;
      point.rotation = rotation;
      point.amount = amount;
      std::vector<double> gaps, excesses;
      for (int i = 0; i < options.directions; ++i) {
        const Eigen::Vector3d along = direction(i, options.directions, options.seed);
        const double radians = amount * radians_per_degree;
        const Pose by = rotation ? Pose{rotation_exp(radians * along), Eigen::Vector3d::Zero()}
                                 : Pose{Eigen::Quaterniond::Identity(), amount * along};
        const DualQuaternion q = optimum.q * to_dual_quaternion(by);
        const Certificate certificate = verify(Q, q);
        gaps.push_back(certificate.gap);
        excesses.push_back(certificate.cost - optimum.cost);
        point.certified += certificate.optimality == Optimality::certified;
        point.disproved += certificate.optimality == Optimality::not_optimal;
        ++point.runs;
      }
      std::sort(gaps.begin(), gaps.end());
      std::sort(excesses.begin(), excesses.end());
      if (!gaps.empty()) {
        point.gap_least = gaps.front();
        point.gap_median = gaps[gaps.size() / 2];
        point.gap_most = gaps.back();
        point.excess_median = excesses[excesses.size() / 2];
      }
      points.push_back(point);
    };
    for (const double amount : options.rotations) falsify(true, amount);
    for (const double amount : options.translations) falsify(false, amount);
  }
  return points;
}

std::string csv(const std::vector<GlobalityPoint>& points) {
  std::string text =
      "frames,falsified,amount,unit,gap_least,gap_median,gap_most,excess_median,certified,disproved,runs\n";
  for (const GlobalityPoint& p : points)
    text +=
        fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{}\n", p.frames,
                    p.rotation ? "rotation" : "translation", p.amount, p.rotation ? "deg" : "m", p.gap_least,
                    p.gap_median, p.gap_most, p.excess_median, p.certified, p.disproved, p.runs);
  return text;
}

std::vector<Panel> panels(const std::vector<GlobalityPoint>& points) {
  constexpr Colour colours[] = {Colour::blue, Colour::vermilion, Colour::green, Colour::orange,
                                Colour::purple};
  std::vector<Panel> result;
  for (const bool rotation : {true, false}) {
    Plot plot;
    plot.title = "Duality gap of a falsified optimum";
    plot.x = {rotation ? "rotation falsified by [deg]" : "translation falsified by [m]",
              AxisScale::logarithmic,
              {},
              {}};
    plot.y = {"duality gap", AxisScale::logarithmic, {}, {}};
    for (const GlobalityPoint& point : points) {
      if (point.rotation != rotation) continue;
      const std::string name = fmt::format("{} frames", point.frames);
      if (plot.series.empty() || plot.series.back().name != name) {
        Series series;
        series.name = name;
        // the curves lie on each other: points on dashes on a line
        constexpr Series::Style styles[] = {Series::Style::points, Series::Style::dashes,
                                            Series::Style::line};
        series.colour = colours[plot.series.size() % std::size(colours)];
        series.style = styles[std::min(plot.series.size(), std::size(styles) - 1)];
        series.radius = 2;
        plot.series.push_back(series);
      }
      plot.series.back().x.push_back(point.amount);
      plot.series.back().y.push_back(point.gap_median);
    }
    std::reverse(plot.series.begin(), plot.series.end());
    result.push_back({rotation ? "rotation" : "translation", plot});
  }
  return result;
}

}  // namespace egocal::tools
