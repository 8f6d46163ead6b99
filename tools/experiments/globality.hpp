// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "egocal/certificate/certificate.hpp"
#include "experiments/data_set.hpp"
#include "experiments/figure.hpp"

namespace egocal::tools {

/// Section V-F: the optimum falsified by growing amounts, and the result of its verification.
struct GlobalityOptions {
  std::vector<double> rotations = {0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 20};             ///< [deg]
  std::vector<double> translations = {0.0001, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 20};  ///< [m]
  std::vector<double> parts = {0.25, 0.5,
                               1};  ///< of the data set: the gap must not depend on the number of frames
  int directions = 20;              ///< random ones for each amount
  std::uint64_t seed = 1;
};

struct GlobalityPoint {
  std::size_t frames = 0;
  bool rotation = false;  ///< what was falsified: the rotation, or the translation
  double amount = 0;      ///< [deg] or [m]
  double gap_least = 0, gap_median = 0, gap_most = 0;  ///< over the directions
  double excess_median = 0;                            ///< cost above the optimum
  int certified = 0, disproved = 0, runs = 0;
};

std::vector<GlobalityPoint> globality_experiment(const DataSet& data, const GlobalityOptions& options);

std::string csv(const std::vector<GlobalityPoint>& points);
/// Gap against falsification of the rotation and of the translation, for each number of frames.
std::vector<Panel> panels(const std::vector<GlobalityPoint>& points);

}  // namespace egocal::tools
