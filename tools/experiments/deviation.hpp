// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace egocal::tools {

/// Error vectors of repeated runs, split into what the runs share (a bias, which more data do not take away)
/// and how each differs from it.
struct Deviations {
  Eigen::Vector3d common = Eigen::Vector3d::Zero();  ///< the median of each component
  std::vector<double> lengths;                       ///< of error - common, run by run
};

/// The deviations of these errors; empty without runs.
Deviations deviations(const std::vector<Eigen::Vector3d>& errors);

}  // namespace egocal::tools
