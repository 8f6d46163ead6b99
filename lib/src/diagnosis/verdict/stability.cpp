// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/stability.hpp"

#include <cmath>
#include <vector>

#include "egocal/uncertainty/leave_out.hpp"
#include "solvers/minimiser.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/takes_off.hpp"

namespace egocal::detail {

namespace {

/// What blocks that touch each other share is not known pair by pair: what each of a fifth changes is added
/// up, less what is counted more than once on average.
std::vector<Vector6d> without_touching_parts(const Problem& problem, const DualQuaternion& T_a_b,
                                             std::size_t parts) {
  const std::vector<Vector6d> each = leave_out_differences(problem, cost_matrix(problem), T_a_b);
  const double whole = sum_blocks(problem.blocks).weight;
  const double times_counted = (whole - problem.blocks.back().weight) / whole;
  std::vector<Vector6d> answers;
  for (std::size_t part = 0; part < parts; ++part) {
    answers.emplace_back(Vector6d::Zero());
    for (std::size_t i = part * each.size() / parts; i < (part + 1) * each.size() / parts; ++i)
      answers.back() += each[i] / times_counted;
  }
  return answers;
}

std::vector<Vector6d> without_parts(const Problem& problem, const DualQuaternion& T_a_b, std::size_t parts) {
  const std::size_t n = problem.blocks.size();
  std::vector<Vector6d> answers;
  for (std::size_t part = 0; part < parts; ++part) {
    Statistics rest;
    for (std::size_t i = 0; i < n; ++i)
      if (i < part * n / parts || i >= (part + 1) * n / parts) rest += problem.blocks[i];
    answers.push_back(frame_a_difference(T_a_b, extrinsic_of(problem, rest)));
  }
  return answers;
}

}  // namespace

std::array<double, 6> spread_without_fifths(const Problem& problem, const DualQuaternion& T_a_b,
                                            const StabilityOptions& options) {
  const std::size_t parts = options.parts;
  std::array<double, 6> spread{};
  if (problem.blocks.size() < 2 * parts) return spread;
  const std::vector<Vector6d> answers = takes_off(problem.blocks.back())
                                            ? without_touching_parts(problem, T_a_b, parts)
                                            : without_parts(problem, T_a_b, parts);
  Vector6d mean = Vector6d::Zero();
  for (const Vector6d& answer : answers) mean += answer / static_cast<double>(parts);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    double sum = 0;
    for (const Vector6d& answer : answers) sum += (answer[k] - mean[k]) * (answer[k] - mean[k]);
    spread[i] = std::sqrt(sum * static_cast<double>(parts - 1) / static_cast<double>(parts));
  }
  return spread;
}

}  // namespace egocal::detail
