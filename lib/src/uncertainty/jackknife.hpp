// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "solvers/tangent.hpp"
#include "statistics/distributions.hpp"

namespace egocal::detail {

/// Standard deviations by omitting blocks of unequal length m of n pairs (delete-m_j jack-knife, Busing et
/// al. 1999).
class Jackknife {
 public:
  explicit Jackknife(double pairs) : pairs_(pairs) {}
  /// difference: estimate without the block minus estimate with all. information: what part of what is known
  /// of each direction the block holds, up to a common factor.
  void leave_out(double block_pairs, const Vector6d& difference, const Vector6d& information) {
    const double h = pairs_ / block_pairs;
    const Vector6d pseudo = -(h - 1) * difference;  // pseudo value minus the estimate with all
    count_ += 1;
    sum_ += pseudo / h;
    squares_ += pseudo.cwiseAbs2() / (h - 1);
    cross_ += pseudo / (h - 1);
    weights_ += 1 / (h - 1);
    information_ += information;
    information_squares_ += information.cwiseAbs2();
  }
  /// Mean of (pseudo - mean)^2 / (h - 1).
  Vector6d spread() const {
    return (squares_ - 2 * sum_.cwiseProduct(cross_) + sum_.cwiseAbs2() * weights_) / count_;
  }
  /// With Student's factor: 1.96 of its roots cover 95 % whatever the number of blocks.
  Vector6d variance() const {
    const double student = student_factor(count_ - 1);
    return student * student * spread();
  }
  /// For the standard deviations, where few of the n blocks hold all that is known of a direction (one turn
  /// in the drive): m = (sum of c)^2 / sum of c^2 equal blocks are as concentrated. The factor is Student's
  /// for about m degrees of freedom (Satterthwaite 1946), times the root of (m - 1) / m to (n - 1) / n, the
  /// part by which the jack-knife over m overestimates. One where all blocks hold alike.
  Vector6d concentration(double least_equal_blocks) const {
    Vector6d factor;
    for (int i = 0; i < 6; ++i) {
      const double squares = information_squares_[i];
      const double all = squares > 0 ? information_[i] * information_[i] / squares : count_;
      const double m = std::clamp(all, least_equal_blocks, count_);
      factor[i] = student_factor(m - m / count_) / student_factor(count_ - 1) *
                  std::sqrt((m - 1) / m * count_ / (count_ - 1));
    }
    return factor;
  }

 private:
  double pairs_;
  double count_ = 0, weights_ = 0;
  Vector6d sum_ = Vector6d::Zero(), squares_ = Vector6d::Zero(), cross_ = Vector6d::Zero();
  Vector6d information_ = Vector6d::Zero(), information_squares_ = Vector6d::Zero();
};

}  // namespace egocal::detail
