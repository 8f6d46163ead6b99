// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/spread_by_poses.hpp"

#include <cmath>

#include "egocal/uncertainty/leave_out.hpp"
#include "egocal/uncertainty/observability.hpp"
#include "online/solve_and_verify.hpp"
#include "solvers/minimiser.hpp"

namespace egocal::detail {

SeenDirections seen_directions(const Problem& problem) {
  const Matrix8d Q = cost_matrix(problem);
  const Answer answer = solve_and_verify(problem, Q, Method::dual);
  return observable_directions(problem, Q, answer.T_a_b, ErrorCorrelation::independent);
}

SpreadByPoses spread_by_poses(const Problem& problem, const SeenDirections& seen) {
  const Matrix8d Q = cost_matrix(problem);
  const DualQuaternion T_a_b = extrinsic_of(problem, minimiser(Q, problem.mode));
  const auto differences = leave_out_differences(problem, Q, T_a_b);
  const auto blocks = static_cast<double>(differences.size());
  Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
  for (const auto& difference : differences) mean += difference / blocks;
  SpreadByPoses result;
  result.T_a_b = T_a_b;
  std::vector<std::array<double, 2>> squares;
  std::array<double, 2> sums{};
  for (const auto& difference : differences) {
    Vector6d shown = difference - mean;
    for (std::size_t i = 0; i < 6; ++i)
      if (!seen[i]) shown[static_cast<Eigen::Index>(i)] = 0;
    result.covariance += (blocks - 1) / blocks * (shown * shown.transpose());
    squares.emplace_back();
    for (std::size_t i = 0; i < 6; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double square = std::pow(difference[k] - mean[k], 2);
      if (seen[i]) squares.back()[i < 3 ? 0 : 1] += square;
    }
    for (const std::size_t part : {0u, 1u}) sums[part] += squares.back()[part];
  }
  result.translation = std::sqrt(sums[0] * (blocks - 1) / blocks);
  result.rotation = std::sqrt(sums[1] * (blocks - 1) / blocks);
  for (const std::size_t part : {0u, 1u}) result.score += sums[part] > 0 ? 0.5 * std::log(sums[part]) : 0;
  for (const auto& square : squares) {
    double influence = 0;
    for (const std::size_t part : {0u, 1u}) influence += sums[part] > 0 ? 0.5 * square[part] / sums[part] : 0;
    result.influence.push_back(influence);
  }
  return result;
}

void SpreadByPoses::widen(double of_rotation, double of_translation) {
  if (rotation > 0) score += std::log(of_rotation);
  if (translation > 0) score += std::log(of_translation);
  rotation *= of_rotation;
  translation *= of_translation;
  covariance.topRows<3>() *= of_translation;
  covariance.leftCols<3>() *= of_translation;
  covariance.bottomRows<3>() *= of_rotation;
  covariance.rightCols<3>() *= of_rotation;
}

double standard_error(const SpreadByPoses& x, const SpreadByPoses& y) {
  double sum = 0;
  for (std::size_t i = 0; i < x.influence.size(); ++i) sum += std::pow(x.influence[i] - y.influence[i], 2);
  return std::sqrt(sum);
}

}  // namespace egocal::detail
