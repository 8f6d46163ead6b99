// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/stability.hpp"

#include <cmath>
#include <vector>

#include "egocal/solvers/dual.hpp"
#include "egocal/solvers/planar.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

std::array<double, 6> spread_without_fifths(const Problem& problem, const DualQuaternion& T_a_b) {
  constexpr std::size_t parts = 5;
  std::array<double, 6> spread{};
  const std::size_t n = problem.blocks.size();
  if (n < 2 * parts) return spread;
  const bool planar = problem.mode == Mode::planar;
  const DualQuaternion G_a = planar ? plane_frame(problem.plane_a) : DualQuaternion{};
  const DualQuaternion G_b = planar ? plane_frame(problem.plane_b) : DualQuaternion{};
  std::vector<Vector6d> answers;
  Vector6d mean = Vector6d::Zero();
  for (std::size_t part = 0; part < parts; ++part) {
    Statistics rest;
    for (std::size_t i = 0; i < n; ++i)
      if (i < part * n / parts || i >= (part + 1) * n / parts) rest += problem.blocks[i];
    const Matrix8d Q = cost_matrix(rest, problem.balance);
    const DualQuaternion T = planar ? extrinsic_from_planar(solve_planar(Q).q, G_a, G_b) : solve_dual(Q).q;
    answers.push_back(frame_a_difference(T_a_b, T));
    mean += answers.back() / parts;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const int k = static_cast<int>(i);
    double sum = 0;
    for (const Vector6d& answer : answers) sum += (answer[k] - mean[k]) * (answer[k] - mean[k]);
    spread[i] = std::sqrt(sum * (parts - 1) / parts);
  }
  return spread;
}

}  // namespace egocal::detail
