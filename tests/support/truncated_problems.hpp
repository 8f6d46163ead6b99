// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Truncated least squares of drives with wrong blocks, and the search through all choices of outliers.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "egocal/robust/prove_outliers.hpp"
#include "egocal/solvers/global.hpp"
#include "random_motion.hpp"

namespace egocal::testing {

struct TruncatedDrive {
  Motion motion = Motion::free;
  std::size_t blocks = 16;
  std::size_t motions_per_block = 16;
  double outliers = 0.1;       ///< part of the blocks that come from another extrinsic
  double outlier_size = 0.35;  ///< of how far that is off [rad, m]
  double noise = 0.02;         ///< relative
  double limit = 18;           ///< times the typical cost of a block
};

struct TruncatedProblem {
  std::vector<TruncatedPart> parts;
  std::vector<bool> wrong;
};

inline TruncatedProblem truncated_problem(const TruncatedDrive& drive, Random& random) {
  const DualQuaternion T = random_extrinsic(random, 0.5);
  TruncatedProblem problem;
  std::vector<double> costs;
  for (std::size_t k = 0; k < drive.blocks; ++k) {
    const bool wrong = random.uniform() < drive.outliers;
    const DualQuaternion off = testing::normal_displacement(random, drive.outlier_size, drive.outlier_size);
    RandomDrive block;
    block.motion = drive.motion;
    block.pairs = drive.motions_per_block;
    block.noise = drive.noise;
    problem.parts.push_back({cost_of(random_pairs(wrong ? T * off : T, block, random)), 0});
    problem.wrong.push_back(wrong);
    costs.push_back(cost(problem.parts.back().Q, T));
  }
  std::nth_element(costs.begin(), costs.begin() + static_cast<std::ptrdiff_t>(costs.size() / 2), costs.end());
  for (TruncatedPart& part : problem.parts) part.limit = drive.limit * costs[costs.size() / 2];
  return problem;
}

/// Minimum over the parts that are no outliers.
inline DualQuaternion minimum_without(const std::vector<TruncatedPart>& parts,
                                      const std::vector<bool>& outlier) {
  Matrix8d Q = Matrix8d::Zero();
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (!outlier[k]) Q += parts[k].Q;
  return solve_dual(Q).q;
}

inline double truncated_cost(const std::vector<TruncatedPart>& parts, const DualQuaternion& q) {
  double sum = 0;
  for (const TruncatedPart& part : parts) sum += std::min(std::max(0.0, cost(part.Q, q)), part.limit);
  return sum;
}

/// Repeats a choice until it agrees with its own answer; empty: too little is left.
inline std::optional<std::vector<bool>> settled_choice(const std::vector<TruncatedPart>& parts,
                                                       std::vector<bool> outlier) {
  for (int i = 0; i < 30; ++i) {
    if (std::count(outlier.begin(), outlier.end(), false) < 3) return std::nullopt;
    const DualQuaternion q = minimum_without(parts, outlier);
    std::vector<bool> next;
    for (const TruncatedPart& part : parts) next.push_back(cost(part.Q, q) > part.limit);
    if (next == outlier) return outlier;
    outlier = std::move(next);
  }
  return std::nullopt;
}

/// Finds the least truncated cost over all choices of outliers whose limits alone cost at most `most`.
class AllChoices {
 public:
  AllChoices(const std::vector<TruncatedPart>& parts, double most) : parts_(parts), least_(most) {
    Matrix8d Q = Matrix8d::Zero();
    for (const TruncatedPart& part : parts) Q += part.Q;
    visit(Q, 0, 0);
  }
  double least() const { return least_; }

 private:
  void visit(const Matrix8d& Q, double limits, std::size_t next) {
    least_ = std::min(least_, truncated_cost(parts_, solve_dual(Q).q));
    for (std::size_t k = next; k < parts_.size(); ++k)
      if (limits + parts_[k].limit < least_) visit(Q - parts_[k].Q, limits + parts_[k].limit, k + 1);
  }

  const std::vector<TruncatedPart>& parts_;
  double least_;
};

}  // namespace egocal::testing
