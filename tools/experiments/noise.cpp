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
#include "egocal/evaluation/errors.hpp"
#include "egocal/simulation/simulation.hpp"
#include "egocal/solvers/dual.hpp"
#include "experiments/data_set.hpp"

namespace egocal::tools {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

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

/// Exchanges the motions at random; the same seed gives the same order on every machine (splitmix64,
/// Fisher-Yates).
void mix(std::vector<MotionPair>& pairs, std::uint64_t seed) {
  const auto next = [&seed] {
    std::uint64_t z = seed += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
  };
  for (std::size_t i = pairs.size(); i > 1; --i) std::swap(pairs[i - 1], pairs[next() % i]);
}

struct Sample {
  double translation, rotation;
  bool certified;
  double seconds;  ///< to solve and to prove
};

NoisePoint::Errors errors_of(const std::vector<double>& errors) {
  return {median(errors), quantile(errors, 0.25), quantile(errors, 0.75),
          *std::max_element(errors.begin(), errors.end())};
}

/// Slope of the least-squares line through (log n, log error).
double slope(const std::vector<double>& sizes, const std::vector<double>& errors) {
  const auto n = static_cast<double>(sizes.size());
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]), y = std::log(errors[i]);
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

/// Mean of the slopes of the runs, and its standard error.
Exponent exponent(const std::vector<const NoisePoint*>& points,
                  std::vector<double> NoisePoint::*errors_of_runs) {
  std::vector<double> sizes, slopes;
  for (const NoisePoint* point : points) sizes.push_back(point->pairs);
  const std::size_t runs = points.empty() ? 0 : (points.front()->*errors_of_runs).size();
  for (std::size_t run = 0; run < runs; ++run) {
    std::vector<double> errors;
    for (const NoisePoint* point : points) errors.push_back((point->*errors_of_runs)[run]);
    slopes.push_back(slope(sizes, errors));
  }
  const auto n = static_cast<double>(runs);
  Exponent result;
  double squares = 0;
  for (const double one : slopes) result.mean += one / n;
  for (const double one : slopes) squares += (one - result.mean) * (one - result.mean);
  result.standard_error = runs > 1 ? std::sqrt(squares / (n * (n - 1))) : 0;
  return result;
}

/// One curve a noise level, with the band between the quartiles.
Plot error_plot(const std::vector<NoisePoint>& points, const std::string& title, const std::string& unit,
                NoisePoint::Errors NoisePoint::*errors, double factor) {
  constexpr Colour colours[] = {Colour::blue,   Colour::vermilion, Colour::green,
                                Colour::orange, Colour::purple,    Colour::black};
  Plot plot;
  plot.title = title;
  plot.x = {"motion pairs", AxisScale::logarithmic, 1.0, {}};  // room for the legend beside the curves
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

}  // namespace

std::vector<NoisePoint> noise_experiment(const NoiseOptions& options,
                                         const std::function<void(double)>& progress) {
  const std::vector<int> sizes = sizes_of(options);
  std::vector<NoisePoint> points;
  int done = 0;
  const int drives = static_cast<int>(options.levels.size()) * options.sensors * options.repeats;
  for (const double level : options.levels) {
    std::map<int, std::vector<Sample>> samples;
    for (int sensor = 0; sensor < options.sensors; ++sensor) {
      const Pose T = sensor_pose(sensor, options.sensors);
      const DualQuaternion truth = to_dual_quaternion(T);
      for (int repeat = 0; repeat < options.repeats; ++repeat) {
        SimulationOptions simulation;
        simulation.terrain = Terrain::rough;
        simulation.poses = options.most_pairs + 1;
        simulation.T_vehicle_sensor = {Pose{}, T};
        simulation.relative_noise = level;
        simulation.seed = options.seed + static_cast<std::uint64_t>(1000 * sensor + repeat);
        const std::vector<Trajectory> trajectories = simulate(simulation);
        std::vector<MotionPair> pairs = motions(trajectories[0], trajectories[1]);
        if (options.mixed) mix(pairs, simulation.seed);
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
          const ExtrinsicError error = extrinsic_error(truth, solution.q);
          samples[size].push_back({error.translation, error.rotation, certified, time.count()});
        }
        if (progress) progress(static_cast<double>(++done) / drives);
      }
    }
    for (const auto& [size, runs] : samples) {
      NoisePoint point;
      point.level = level;
      point.pairs = size;
      for (const Sample& run : runs) {
        point.translations.push_back(run.translation);
        point.rotations.push_back(run.rotation);
        point.certified += run.certified;
        point.solve_seconds += run.seconds;
        ++point.runs;
      }
      point.translation = errors_of(point.translations);
      point.rotation = errors_of(point.rotations);
      points.push_back(point);
    }
  }
  return points;
}

std::vector<NoiseSlope> slopes(const std::vector<NoisePoint>& points) {
  constexpr int least_pairs = 100;  // below, single motions decide
  std::vector<NoiseSlope> result;
  std::vector<double> levels;
  for (const NoisePoint& point : points)
    if (levels.empty() || levels.back() != point.level) levels.push_back(point.level);
  for (const double level : levels) {
    std::vector<const NoisePoint*> sizes;
    for (const int least : {least_pairs, 0}) {
      if (sizes.size() >= 3) break;
      sizes.clear();
      for (const NoisePoint& point : points)
        if (point.level == level && point.pairs > least) sizes.push_back(&point);
    }
    result.push_back(
        {level, exponent(sizes, &NoisePoint::translations), exponent(sizes, &NoisePoint::rotations)});
  }
  return result;
}

std::string csv(const std::vector<NoisePoint>& points) {
  std::string text =
      "noise,pairs,translation_median_m,translation_quartile_1_m,translation_quartile_3_m,translation_worst_"
      "m,"
      "rotation_median_deg,rotation_quartile_1_deg,rotation_quartile_3_deg,rotation_worst_deg,certified,"
      "runs\n";
  const auto numbers = [](const NoisePoint::Errors& errors, double factor) {
    return fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}", factor * errors.median, factor * errors.lower_quartile,
                       factor * errors.upper_quartile, factor * errors.worst);
  };
  for (const NoisePoint& p : points)
    text += fmt::format("{},{},{},{},{},{}\n", p.level, p.pairs, numbers(p.translation, 1),
                        numbers(p.rotation, degrees), p.certified, p.runs);
  return text;
}

std::vector<Panel> panels(const std::vector<NoisePoint>& points) {
  return {{"translation", error_plot(points, "Translation error by noise level", "median error [m]",
                                     &NoisePoint::translation, 1)},
          {"rotation", error_plot(points, "Rotation error by noise level", "median error [deg]",
                                  &NoisePoint::rotation, degrees)}};
}

}  // namespace egocal::tools
