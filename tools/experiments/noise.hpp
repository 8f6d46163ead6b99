// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace egocal::tools {

/// Section V-B, Fig. 4: simulated drives on a rough surface, noise levels, sizes, sensor poses 2 to 8 m
/// apart.
struct NoiseOptions {
  std::vector<double> levels = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5};  ///< relative to the mean motion
  int most_pairs = 1000;
  int sizes = 20;   ///< between 10 and most_pairs, evenly on a logarithmic scale
  int sensors = 8;  ///< poses of sensor b
  int repeats = 8;  ///< runs of each
  std::uint64_t seed = 1;
};

struct NoisePoint {
  double level = 0;
  int pairs = 0;
  double translation = 0, rotation = 0;              ///< medians of the errors (32) [m, rad]
  double translation_worst = 0, rotation_worst = 0;  ///< largest
  int certified = 0, runs = 0;
};

/// progress is called with the part that is done, 0 to 1.
std::vector<NoisePoint> noise_experiment(const NoiseOptions& options,
                                         const std::function<void(double)>& progress);

std::string csv(const std::vector<NoisePoint>& points);
/// A gnuplot script that draws Fig. 4 from the CSV file into the PNG file.
std::string plot(const std::vector<NoisePoint>& points, const std::string& csv_file,
                 const std::string& png_file);

}  // namespace egocal::tools
