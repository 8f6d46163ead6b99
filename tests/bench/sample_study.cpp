// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// calibrate_samples() against methods that OpenCV offers, on simulated sets of still poses: errors, coverage
// of the standard deviations, wrong samples. The tables of docs/samples.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include "egocal/baselines/baselines.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/samples/calibrate_samples.hpp"
#include "support/arm_samples.hpp"
#include "support/hand_eye_rivals.hpp"

namespace {

using namespace egocal;
using testing::ArmSamples;
using testing::Random;
using testing::SimulatedSamples;

constexpr double degrees = 180 / std::numbers::pi;

struct Noise {
  double rotation, position;  ///< [deg], [mm]
};
constexpr Noise noises[] = {{0.05, 5}, {0.1, 1}, {0.3, 2}, {1, 5}};
constexpr const char* methods[] = {"egocal", "PARK", "ANDREFF", "DANIILIDIS"};

struct Errors {
  std::vector<double> rotation, translation;  ///< [deg], [mm]

  void add(const DualQuaternion& truth, const DualQuaternion& found) {
    const ExtrinsicError error = extrinsic_error(truth, found);
    rotation.push_back(error.rotation * degrees);
    translation.push_back(1e3 * error.translation);
  }
};

double quantile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(part * static_cast<double>(values.size())))];
}

DualQuaternion daniilidis(const std::vector<PoseSample>& samples) {
  std::vector<MotionPair> pairs;
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t j = i + 1; j < samples.size(); ++j)
      pairs.push_back({canonical_sign(conjugate(samples[i].a) * samples[j].a),
                       canonical_sign(conjugate(samples[i].b) * samples[j].b)});
  return solve_analytic(pairs).T_a_b;
}

/// Tangent of the error in the frame of a: what the standard deviations are of.
Eigen::Matrix<double, 6, 1> deviation(const Pose& truth, const Pose& found) {
  Eigen::Matrix<double, 6, 1> x;
  x << found.translation - truth.translation, rotation_log(found.rotation * truth.rotation.conjugate());
  return x;
}

struct Cell {
  Errors errors[4];
  double covered = 0, directions = 0;
  std::size_t false_alarms = 0;
};

Cell measure(const ArmSamples& what, std::size_t trials, std::uint64_t seed, const SampleOptions& options) {
  Cell cell;
  Random random(seed);
  for (std::size_t trial = 0; trial < trials; ++trial) {
    const SimulatedSamples drawn = testing::simulate_arm(what, random);
    const SampleCalibration found = calibrate_samples(drawn.samples, options);
    cell.errors[0].add(drawn.X, to_dual_quaternion(found.calibration.T_a_b));
    const std::vector<testing::PoseMotion> motions = testing::all_motions(drawn.samples);
    cell.errors[1].add(drawn.X, to_dual_quaternion(testing::park(motions)));
    cell.errors[2].add(drawn.X, to_dual_quaternion(testing::andreff(motions)));
    cell.errors[3].add(drawn.X, daniilidis(drawn.samples));
    cell.false_alarms += found.calibration.counts.outliers > 0 ? 1 : 0;
    const Eigen::Matrix<double, 6, 1> off = deviation(to_pose(drawn.X), found.calibration.T_a_b);
    for (int i = 0; i < 6; ++i) {
      cell.directions += 1;
      if (std::abs(off[i]) <= 1.96 * found.calibration.observability.stddev[static_cast<std::size_t>(i)])
        cell.covered += 1;
    }
  }
  return cell;
}

/// Milliseconds of processor time of one call with its proof, verdict and standard deviations: the median of
/// `repeats` sets.
double milliseconds(std::size_t n, std::size_t repeats, bool diagnosis) {
  ArmSamples what;
  what.samples = n;
  SampleOptions options;
  options.diagnosis.enabled = diagnosis;
  Random random(1);
  std::vector<double> times;
  for (std::size_t i = 0; i < repeats; ++i) {
    const SimulatedSamples drawn = testing::simulate_arm(what, random);
    const std::clock_t begin = std::clock();
    const SampleCalibration found = calibrate_samples(drawn.samples, options);
    times.push_back(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    if (found.calibration.certificate.optimality != Optimality::certified) std::printf("not certified\n");
  }
  return quantile(times, 0.5);
}

/// Trials in which exactly the wrong samples were omitted and no direction of the answer is off by more than
/// six stated standard deviations.
std::size_t found_wrong(const ArmSamples& what, std::size_t trials, std::uint64_t seed,
                        const SampleOptions& options) {
  std::size_t right = 0;
  Random random(seed);
  for (std::size_t trial = 0; trial < trials; ++trial) {
    const SimulatedSamples drawn = testing::simulate_arm(what, random);
    const SampleCalibration found = calibrate_samples(drawn.samples, options);
    const Eigen::Matrix<double, 6, 1> off = deviation(to_pose(drawn.X), found.calibration.T_a_b);
    constexpr double most_sigmas = 6;  // chance, where what is stated is right
    bool same = true;
    for (int k = 0; k < 6; ++k)
      same = same && std::abs(off[k]) <=
                         most_sigmas * found.calibration.observability.stddev[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < drawn.wrong.size(); ++i)
      same = same && found.residuals[i].wrong == drawn.wrong[i];
    right += same ? 1 : 0;
  }
  return right;
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t trials = 500;
  std::vector<double> sizes{3, 4, 5, 6, 8, 10, 15, 20, 30, 60};
  bool check = false;
  SampleOptions options;
  options.diagnosis.enabled = false;
  std::size_t timed = 0;
  egocal::cli::Program app("sample_study", "Hand-eye calibration from sets of still poses");
  app.add_option("--trials", trials, "per cell").check(egocal::cli::Check::range(1, 100000));
  app.add_option("--samples", sizes, "numbers of samples");
  app.add_option("--prior-log-ratio", options.prior_log_ratio, "of SampleOptions").show_default();
  app.add_option("--time", timed,
                 "only the time of a call: the median over this number of sets of each size");
  app.add_flag("--check", check,
               "exit 1 where egocal is not better than the others on average over the cells, its deviations "
               "do not cover, or wrong samples are not found");
  if (const auto code = app.parse(argc, argv)) return *code;

  if (timed > 0) {
    for (const double size : sizes) {
      const auto n = static_cast<std::size_t>(size);
      std::printf("%4zu samples %8.3f ms, without other readings %8.3f ms\n", n, milliseconds(n, timed, true),
                  milliseconds(n, timed, false));
    }
    return 0;
  }

  // single cells of few trials scatter; their means do not
  double log_ratios = 0, log_ratios_high = 0, ratios = 0, covered = 0, cells = 0;
  bool good = true;
  std::printf("median and 95 %% of the error; ratio: egocal to the best of the others\n");
  std::printf("%4s %4s %11s  %-19s %-19s %-19s %-19s %6s %6s %8s %6s\n", "cone", "n", "noise", methods[0],
              methods[1], methods[2], methods[3], "median", "95 %", "coverage", "alarms");
  for (const double cone : {45.0, 20.0})
    for (const double size : sizes)
      for (const Noise& noise : noises) {
        const auto n = static_cast<std::size_t>(size);
        ArmSamples what;
        what.samples = n;
        what.cone = cone;
        what.rotation_noise = noise.rotation;
        what.position_noise = noise.position;
        const Cell cell = measure(what, trials, 1000 * n + static_cast<std::uint64_t>(cone), options);
        for (const bool rotation : {true, false}) {
          double median[4], high[4];
          for (int i = 0; i < 4; ++i) {
            const std::vector<double>& values =
                rotation ? cell.errors[i].rotation : cell.errors[i].translation;
            median[i] = quantile(values, 0.5);
            high[i] = quantile(values, 0.95);
          }
          std::printf("%4.0f %4zu %4g deg %g mm", cone, n, noise.rotation, noise.position);
          for (int i = 0; i < 4; ++i) std::printf("  %8.3f (%8.3f)", median[i], high[i]);
          const double ratio = median[0] / *std::min_element(median + 1, median + 4);
          const double ratio_high = high[0] / *std::min_element(high + 1, high + 4);
          std::printf(" %6.2f %6.2f", ratio, ratio_high);
          if (rotation)
            std::printf(" %7.1f%% %6.1f%% deg\n", 100 * cell.covered / cell.directions,
                        100 * static_cast<double>(cell.false_alarms) / static_cast<double>(trials));
          else
            std::printf("                  mm\n");
          log_ratios += std::log(ratio);
          log_ratios_high += std::log(ratio_high);
          ratios += 1;
        }
        if (n >= 8) {
          covered += cell.covered / cell.directions;
          cells += 1;
        }
        std::fflush(stdout);
      }
  std::printf("\nwrong samples found, exactly these [%%]\n");
  for (const auto& [n, wrong] :
       {std::pair{6, 1}, {8, 1}, {10, 1}, {10, 2}, {15, 3}, {20, 4}, {30, 6}, {60, 12}})
    for (const Noise& noise : noises) {
      ArmSamples what;
      what.samples = static_cast<std::size_t>(n);
      what.wrong = static_cast<std::size_t>(wrong);
      what.rotation_noise = noise.rotation;
      what.position_noise = noise.position;
      const std::size_t right = found_wrong(what, trials, static_cast<std::uint64_t>(n), options);
      std::printf("%4d %4d %4g deg %g mm %6.1f\n", n, wrong, noise.rotation, noise.position,
                  100 * static_cast<double>(right) / static_cast<double>(trials));
      std::fflush(stdout);
      if (100 * right < 94 * trials) good = false;
    }
  const double mean = std::exp(log_ratios / ratios), mean_high = std::exp(log_ratios_high / ratios);
  std::printf("mean ratio %.2f of medians, %.2f of 95 %%; coverage from 8 samples on %.1f %%\n", mean,
              mean_high, 100 * covered / cells);
  good =
      good && mean < 1 && mean_high < 1 && (cells == 0 || (covered / cells > 0.9 && covered / cells < 0.98));
  return check && !good ? 1 : 0;
}
