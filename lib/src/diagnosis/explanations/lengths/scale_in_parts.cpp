// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/lengths/scale_in_parts.hpp"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "egocal/geometry/pose.hpp"

namespace egocal::detail {

double scatter_of_log_scale(const Motions& motions, const Explained& fitted, std::size_t parts) {
  const Pose T = to_pose(fitted.fit.T);
  const std::size_t n = motions.all.size();
  std::vector<double> logs;
  for (std::size_t part = 0; part < parts; ++part) {
    double of_a = 0, of_b = 0;
    for (std::size_t i = part * n / parts; i < (part + 1) * n / parts; ++i) {
      const Motion& motion = motions.all[i];
      // b's translation as a and the extrinsic see it
      const Eigen::Vector3d seen = motion.R_a * T.translation + motion.t_a - T.translation;
      of_a += fitted.fit.weights[i] * seen.squaredNorm();
      of_b += fitted.fit.weights[i] * motion.t_b.squaredNorm();
    }
    if (!(of_a > 0 && of_b > 0)) return INFINITY;
    logs.push_back(0.5 * std::log(of_a / of_b));
  }
  double mean = 0, squares = 0;
  for (const double log : logs) mean += log / static_cast<double>(parts);
  for (const double log : logs) squares += (log - mean) * (log - mean);
  return std::sqrt(squares / static_cast<double>(parts - 1));
}

bool same_scale_in_parts(const Evidence& evidence, const Explanation& scaled,
                         const ScaleInPartsOptions& options) {
  const double size = std::abs(std::log(scaled.scale));
  if (size > options.beyond) return true;
  return size >= options.times *
                     scatter_of_log_scale(evidence.given.explained.motions, scaled.explained, options.parts);
}

}  // namespace egocal::detail
