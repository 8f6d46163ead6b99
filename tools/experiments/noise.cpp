// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/noise.hpp"

#include <fmt/format.h>

#include <algorithm>
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
  const int smallest = std::min(10, options.most_pairs);
  for (int i = 0; i < options.sizes; ++i) {
    const double part = options.sizes > 1 ? static_cast<double>(i) / (options.sizes - 1) : 1;
    const double size = smallest * std::pow(static_cast<double>(options.most_pairs) / smallest, part);
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
  double translation, rotation;
  bool certified;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
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
        const std::vector<MotionPair> pairs = motions(trajectories[0], trajectories[1]);
        // one pass: the statistics of every size are those of the one before and more
        Statistics statistics;
        std::size_t next = 0;
        for (const int size : sizes) {
          for (; next < std::min(pairs.size(), static_cast<std::size_t>(size)); ++next)
            statistics.add(pairs[next]);
          const Matrix8d Q = cost_matrix(statistics);
          const Solution solution = solve_dual(Q);
          const ExtrinsicError error = extrinsic_error(truth, solution.q);
          samples[size].push_back(
              {error.translation, error.rotation, verify(Q, solution.q).optimality == Optimality::certified});
        }
        if (progress) progress(static_cast<double>(++done) / drives);
      }
    }
    for (const auto& [size, runs] : samples) {
      NoisePoint point;
      point.level = level;
      point.pairs = size;
      std::vector<double> translations, rotations;
      for (const Sample& run : runs) {
        translations.push_back(run.translation);
        rotations.push_back(run.rotation);
        point.certified += run.certified;
        ++point.runs;
      }
      point.translation = median(translations);
      point.rotation = median(rotations);
      point.translation_worst = *std::max_element(translations.begin(), translations.end());
      point.rotation_worst = *std::max_element(rotations.begin(), rotations.end());
      points.push_back(point);
    }
  }
  return points;
}

std::string csv(const std::vector<NoisePoint>& points) {
  std::string text =
      "noise,pairs,translation_median_m,rotation_median_deg,translation_worst_m,rotation_worst_deg,certified,"
      "runs\n";
  for (const NoisePoint& p : points)
    text += fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.9g},{},{}\n", p.level, p.pairs, p.translation,
                        degrees * p.rotation, p.translation_worst, degrees * p.rotation_worst, p.certified,
                        p.runs);
  return text;
}

std::string plot(const std::vector<NoisePoint>& points, const std::string& csv_file,
                 const std::string& png_file) {
  std::vector<double> levels;
  for (const NoisePoint& p : points)
    if (levels.empty() || levels.back() != p.level) levels.push_back(p.level);
  std::string script = fmt::format(
      "set terminal pngcairo size 900,600\nset output '{}'\nset datafile separator ','\nset logscale xy\nset "
      "grid\n"
      "set xlabel 'motion pairs'\nset ylabel 'translation error, median [m]'\nset key outside title "
      "'noise'\nplot ",
      png_file);
  for (std::size_t i = 0; i < levels.size(); ++i)
    script += fmt::format("{}'{}' using ($1=={} ? $2 : NaN):3 with linespoints title '{:g} %'", i ? ", " : "",
                          csv_file, levels[i], 100 * levels[i]);
  return script + "\n";
}

}  // namespace egocal::tools
