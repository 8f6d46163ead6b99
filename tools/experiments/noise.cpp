// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

#include "egocal/certificate/certificate.hpp"
#include "egocal/degrees.hpp"
#include "egocal/estimation/attenuation.hpp"
#include "egocal/solvers/global.hpp"
#include "experiments/deviation.hpp"
#include "experiments/noisy_drive.hpp"

namespace egocal::tools {

namespace {

/// At 50 % noise two fifths of what shows the translation are noise in the mean, and more along some ways.
constexpr double most_noise = 0.75;

std::vector<int> sizes_of(const NoiseOptions& options) {
  std::vector<int> sizes;
  const int smallest = std::min(options.even_sizes ? 4 : 10, options.most_pairs);
  for (int i = 0; i < options.sizes; ++i) {
    const double part = options.sizes > 1 ? static_cast<double>(i) / (options.sizes - 1) : 1;
    const double size = options.even_sizes
                            ? smallest + part * (options.most_pairs - smallest)
                            : smallest * std::pow(static_cast<double>(options.most_pairs) / smallest, part);
    sizes.push_back(static_cast<int>(std::lround(size)));
  }
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  return sizes;
}

/// Distances from 2 to 8 m from sensor a, in all directions round the vehicle, turned by a third of a turn a
/// step.
Pose sensor_pose(int index, int sensors) {
  const double part = sensors > 1 ? static_cast<double>(index) / (sensors - 1) : 0;
  const double distance = 2 + 6 * part;
  const double heading = 2 * std::numbers::pi * index / sensors;
  const Eigen::Vector3d direction = Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.2).normalized();
  const Eigen::Vector3d turn(0.1 * index, -0.15 * index, 2 * std::numbers::pi / 3 * index);
  return {rotation_exp(turn), distance * direction};
}

struct Sample {
  Eigen::Vector3d translation, rotation;  ///< errors, in sensor a's and in sensor b's frame [m, rad]
  Eigen::Vector3d corrected;              ///< error of the translation with the noise taken off [m]
  bool certified;
  double seconds;  ///< to solve and to prove
};

NoisePoint::Errors errors_of(const std::vector<double>& errors) {
  return {median(errors), quantile(errors, 0.25), quantile(errors, 0.75),
          *std::max_element(errors.begin(), errors.end())};
}

/// Runs of one sensor pose after another, `repeats` of each.
NoisePoint point_of(const std::vector<Sample>& samples, const NoiseOptions& options) {
  NoisePoint point;
  const auto lengths = [](std::vector<double>& to, const std::vector<Eigen::Vector3d>& errors) {
    for (const Eigen::Vector3d& error : errors) to.push_back(error.norm());
  };
  const auto append = [](std::vector<double>& to, const std::vector<double>& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  const auto repeats = static_cast<std::size_t>(options.repeats);
  for (int sensor = 0; sensor < options.sensors; ++sensor) {
    std::vector<Eigen::Vector3d> translations, rotations;
    for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
      const Sample& sample = samples[static_cast<std::size_t>(sensor) * repeats + repeat];
      translations.push_back(sample.translation);
      rotations.push_back(sample.rotation);
      point.corrected_translations.push_back(sample.corrected.norm());
      point.certified += sample.certified;
      point.solve_seconds += sample.seconds;
      ++point.runs;
    }
    lengths(point.translations, translations);
    lengths(point.rotations, rotations);
    const Deviations translation = deviations(translations);
    append(point.translation_deviations, translation.lengths);
    append(point.rotation_deviations, deviations(rotations).lengths);
    const Eigen::Vector3d t = sensor_pose(sensor, options.sensors).translation;
    point.shortened -= translation.common.dot(t) / t.squaredNorm() / options.sensors;
  }
  point.translation = errors_of(point.translations);
  point.rotation = errors_of(point.rotations);
  point.translation_spread = errors_of(point.translation_deviations);
  point.rotation_spread = errors_of(point.rotation_deviations);
  return point;
}

/// One curve a noise level, with the band between the quartiles.
Plot error_plot(const std::vector<NoisePoint>& points, const std::string& title, const std::string& unit,
                NoisePoint::Errors NoisePoint::*errors, double factor) {
  constexpr Colour colours[] = {Colour::blue,   Colour::vermilion, Colour::green,
                                Colour::orange, Colour::purple,    Colour::black};
  Plot plot;
  plot.title = title;
  plot.x = {"motion pairs", AxisScale::logarithmic, 0.5, {}};  // room for the legend beside the curves
  plot.y = {unit, AxisScale::logarithmic, {}, {}};
  for (const NoisePoint& point : points) {
    const std::string name = fmt::format("{:g} %", 100 * point.level);
    if (plot.series.empty() || plot.series.back().name != name) {
      Series series;
      series.name = name;
      series.colour = colours[plot.series.size() % std::size(colours)];
      if (plot.series.size() % 2 == 1) series.style = Series::Style::dashes;
      plot.series.push_back(series);
    }
    Series& series = plot.series.back();
    series.x.push_back(point.pairs);
    series.y.push_back(factor * (point.*errors).median);
    series.low.push_back(factor * (point.*errors).lower_quartile);
    series.high.push_back(factor * (point.*errors).upper_quartile);
  }
  return plot;
}

/// The answer with the noise of the rotations taken off the cost; as it is where that cannot be.
struct Corrected {
  Eigen::Vector3d translation;
  bool certified = true;
};

Corrected without_noise(const Statistics& statistics, const Solution& plain) {
  Problem problem;
  problem.blocks = {statistics};
  const std::optional<Attenuation> attenuation = whole_attenuation(problem, {.most_noise = most_noise});
  const std::optional<Problem> corrected =
      attenuation ? without_attenuation(problem, *attenuation) : std::nullopt;
  if (!corrected) return {to_pose(plain.q).translation};
  const Matrix8d Q = cost_matrix(*corrected);
  const DualQuaternion q = solve_dual(Q).q;
  return {to_pose(q).translation, verify(Q, q).optimality == Optimality::certified};
}

}  // namespace

std::vector<NoisePoint> noise_experiment(const NoiseOptions& options,
                                         const std::function<void(double)>& progress) {
  const std::vector<int> sizes = sizes_of(options);
  std::vector<NoisyDrive> drives;
  drives.reserve(static_cast<std::size_t>(std::max(0, options.sensors)));
  for (int sensor = 0; sensor < options.sensors; ++sensor)
    drives.emplace_back(DriveOptions{options.most_pairs, options.step, options.roughness,
                                     options.seed + static_cast<std::uint64_t>(sensor)},
                        sensor_pose(sensor, options.sensors));
  std::vector<NoisePoint> points;
  int done = 0;
  const int all = static_cast<int>(options.levels.size()) * options.sensors * options.repeats;
  for (const double level : options.levels) {
    std::map<int, std::vector<Sample>> samples;
    for (int sensor = 0; sensor < options.sensors; ++sensor) {
      const Pose T = sensor_pose(sensor, options.sensors);
      for (int repeat = 0; repeat < options.repeats; ++repeat) {
        const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(1000 * sensor + repeat);
        const std::vector<MotionPair> pairs =
            drives[static_cast<std::size_t>(sensor)].run(level, options.mixed, seed);
        // one pass: the statistics of every size are those of the one before and more
        Statistics statistics;
        std::size_t next = 0;
        for (const int size : sizes) {
          for (; next < std::min(pairs.size(), static_cast<std::size_t>(size)); ++next)
            statistics.add(pairs[next]);
          const Matrix8d Q = cost_matrix(statistics);
          const auto begin = std::chrono::steady_clock::now();
          const Solution solution = solve_dual(Q);
          const bool certified = verify(Q, solution.q).optimality == Optimality::certified;
          const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
          const Pose found = to_pose(solution.q);
          const Corrected corrected = without_noise(statistics, solution);
          samples[size].push_back({found.translation - T.translation,
                                   rotation_log((T.rotation.conjugate() * found.rotation).normalized()),
                                   corrected.translation - T.translation, certified && corrected.certified,
                                   time.count()});
        }
        if (progress) progress(static_cast<double>(++done) / all);
      }
    }
    for (const auto& [size, runs] : samples) {
      points.push_back(point_of(runs, options));
      points.back().level = level;
      points.back().pairs = size;
    }
  }
  return points;
}

std::string csv(const std::vector<NoisePoint>& points) {
  std::string text =
      "noise,pairs,translation_median_m,translation_quartile_1_m,translation_quartile_3_m,"
      "translation_worst_m,rotation_median_deg,rotation_quartile_1_deg,rotation_quartile_3_deg,"
      "rotation_worst_deg,translation_spread_m,rotation_spread_deg,translation_shortened,certified,runs\n";
  const auto numbers = [](const NoisePoint::Errors& errors, double factor) {
    return fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}", factor * errors.median, factor * errors.lower_quartile,
                       factor * errors.upper_quartile, factor * errors.worst);
  };
  for (const NoisePoint& p : points)
    text +=
        fmt::format("{},{},{},{},{:.9g},{:.9g},{:.9g},{},{}\n", p.level, p.pairs, numbers(p.translation, 1),
                    numbers(p.rotation, degrees_per_radian), p.translation_spread.median,
                    degrees_per_radian * p.rotation_spread.median, p.shortened, p.certified, p.runs);
  return text;
}

std::vector<Panel> panels(const std::vector<NoisePoint>& points) {
  return {{"translation", error_plot(points, "Translation error by noise level", "median error [m]",
                                     &NoisePoint::translation, 1)},
          {"rotation", error_plot(points, "Rotation error by noise level", "median error [deg]",
                                  &NoisePoint::rotation, degrees_per_radian)},
          {"translation-spread", error_plot(points, "Translation error without its bias",
                                            "median deviation [m]", &NoisePoint::translation_spread, 1)},
          {"rotation-spread", error_plot(points, "Rotation error without its bias", "median deviation [deg]",
                                         &NoisePoint::rotation_spread, degrees_per_radian)}};
}

}  // namespace egocal::tools
