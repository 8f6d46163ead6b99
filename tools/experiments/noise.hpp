// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiments/figure.hpp"

namespace egocal::tools {

/// Section V-B, Fig. 4: simulated drives on a rough surface, noise levels, sizes, sensor poses 2 to 8 m
/// apart.
struct NoiseOptions {
  std::vector<double> levels = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5};  ///< relative to the mean motion
  /// The drive moves 1 m and 0.1 rad from pose to pose, as in the example of V-A: the paper prints nothing
  /// else about its path and surface, and the errors at one noise level depend on them.
  double step = 1;         ///< along the path on the ground [m]
  double roughness = 1.8;  ///< amplitude of the surface [m]
  int most_pairs = 1000;
  int sizes = 20;           ///< between 10 and most_pairs, evenly on a logarithmic scale
  bool even_sizes = false;  ///< on a linear one instead, from 4 on: 167 of them are 4, 10, 16, ..., 1000
  int sensors = 8;          ///< poses of sensor b
  int repeats = 8;          ///< runs of each
  /// A number of pairs is a random sample of the whole drive and not its beginning: every size sees the same
  /// kinds of motion, and what is left is how noise averages (docs/paper.md).
  bool mixed = false;
  std::uint64_t seed = 1;
};

struct NoisePoint {
  double level = 0;
  int pairs = 0;
  /// Statistics of the errors (32) over all runs [m, rad].
  struct Errors {
    double median = 0, lower_quartile = 0, upper_quartile = 0, worst = 0;
  };
  Errors translation, rotation;
  /// The same statistics of the error without what all runs of the same sensor pose share: without the bias
  /// (deviation.hpp).
  Errors translation_spread, rotation_spread;
  /// Errors and deviations run by run: for each sensor pose its repeats, one sensor pose after another.
  std::vector<double> translations, rotations, translation_deviations, rotation_deviations;
  /// Errors of the translation where the noise is taken off the cost (egocal/estimation/attenuation.hpp).
  std::vector<double> corrected_translations;
  /// The shared error of the translation: by which part of its length it comes out too short, mean over the
  /// sensor poses.
  double shortened = 0;
  int certified = 0, runs = 0;
  double solve_seconds = 0;  ///< of solving and proving, all runs together
};

/// progress is called with the part that is done, 0 to 1.
std::vector<NoisePoint> noise_experiment(const NoiseOptions& options,
                                         const std::function<void(double)>& progress);

std::string csv(const std::vector<NoisePoint>& points);

/// Fig. 4, translation and rotation, and the spread of both.
std::vector<Panel> panels(const std::vector<NoisePoint>& points);

}  // namespace egocal::tools
