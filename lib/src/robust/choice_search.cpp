// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "robust/choice_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "certificate/assess.hpp"
#include "egocal/solvers/global.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

namespace {

/// A minimum over parts with its proven lower bound.
struct Minimum {
  DualQuaternion q;
  double bound = 0;
};

Minimum minimum_of(const Matrix8d& Q_metres) {
  const double length = length_scale(Q_metres);
  const Matrix8d Q = in_units_of(length, Matrix8d(0.5 * (Q_metres + Q_metres.transpose())));
  const Solution solution = solve_dual(Q);
  Minimum minimum{in_units_of(1 / length, solution.q), 0};
  if (solution.status != SolverStatus::converged) return minimum;
  const Column<8> v = solution.q.vec();
  const auto bound = best_bound<8>(Q, std::max(0.0, extended_cost<8>(Q, v)),
                                   rounding_of<8>(sizes_of<8>(Q), v), solution.lambda.orthogonal, 0);
  if (bound) minimum.bound = std::max(0.0, bound->bound);
  return minimum;
}

class Search {
 public:
  Search(std::span<const TruncatedPart> parts, const std::vector<bool>& outlier,
         const std::vector<std::size_t>& undecided, double cost, const OutlierProofOptions& options)
      : parts_(parts), outlier_(outlier), undecided_(undecided), cost_(cost), options_(options) {
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      all_ += parts_[k].Q;
      if (outlier_[k]) outliers_ += parts_[k].Q;
    }
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      if (std::binary_search(undecided_.begin(), undecided_.end(), k)) continue;
      if (outlier_[k])
        limits_ += parts_[k].limit;
      else
        Q_ += parts_[k].Q;
    }
  }

  ChoiceSearch run() {
    // the outliers may be the better choice, which a search in order would find late
    for (const Matrix8d& Q : {all_, outliers_}) {
      ++result_.solves;
      if (cheaper(minimum_of(Q).q)) return result_;
    }
    result_.complete = excluded(Q_, limits_, 0);
    return result_;
  }

 private:
  /// Whether no choice of the parts from `next` on costs less than the given one. Undecided parts count with
  /// their least cost, zero.
  bool excluded(const Matrix8d& Q, double limits, std::size_t next) {
    if (result_.better || result_.solves >= options_.most_solves) return false;
    ++result_.solves;
    const Minimum minimum = minimum_of(Q);
    if (minimum.bound + limits >= cost_ * (1 - options_.tolerance)) return true;
    if (cheaper(minimum.q) || next == undecided_.size()) return false;
    const TruncatedPart& part = parts_[undecided_[next]];
    return excluded(Q + part.Q, limits, next + 1) && excluded(Q, limits + part.limit, next + 1);
  }

  /// Whether truncation at this extrinsic is a better choice.
  bool cheaper(const DualQuaternion& q) {
    double sum = 0;
    std::vector<bool> outlier;
    for (const TruncatedPart& part : parts_) {
      const double here = std::max(0.0, egocal::cost(part.Q, q));
      outlier.push_back(here > part.limit);
      sum += std::min(here, part.limit);
    }
    if (!(sum < cost_ * (1 - options_.tolerance))) return false;
    result_.better = std::move(outlier);
    return true;
  }

  std::span<const TruncatedPart> parts_;
  std::vector<bool> outlier_;
  std::vector<std::size_t> undecided_;
  double cost_;
  OutlierProofOptions options_;
  Matrix8d all_ = Matrix8d::Zero(), outliers_ = Matrix8d::Zero();
  Matrix8d Q_ = Matrix8d::Zero();  ///< of the parts that are kept in any case
  double limits_ = 0;
  ChoiceSearch result_;
};

}  // namespace

ChoiceSearch search_choices(std::span<const TruncatedPart> parts, const std::vector<bool>& outlier,
                            const std::vector<std::size_t>& undecided, double cost,
                            const OutlierProofOptions& options) {
  return Search(parts, outlier, undecided, cost, options).run();
}

}  // namespace egocal::detail
