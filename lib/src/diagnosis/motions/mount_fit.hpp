// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The mounting beside two more numbers of one stream (times, lengths), by linear least squares around an
// answer.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace egocal::detail {

struct MountFitOptions {
  std::size_t most = 400;  ///< motions, evenly spread: a limit on time
  /// Squares beyond this many times the median one lose weight: ten standard deviations. The few motions into
  /// and out of turns have up to ten times the residual of the others, and are all the evidence there is.
  double outlier = 100;
  int rounds = 5;          ///< of weights; more change nothing
  std::size_t parts = 24;  ///< of the drive, which the jack-knife omits in turn
};

/// Turn and shift of the mounting in the stream's frame [rad, m], and two numbers whose meaning and units are
/// the caller's.
using MountNumbers = Eigen::Matrix<double, 8, 1>;
constexpr int first_number = 6, second_number = 7;  // places in MountNumbers

/// What one motion leaves, and what each of the eight numbers explains of it [rad, m].
struct LinearMotion {
  Eigen::Matrix<double, 3, 8> of_rotation, of_translation;
  Eigen::Vector3d rotation, translation;
};

/// Which of the two numbers are not zero. one_for_both: they are equal.
enum class FreeNumbers { none, first, one_for_both, two };

/// Reweighted linear least squares, in parts of the drive. The motions must stay.
class MountFit {
 public:
  MountFit(const std::vector<LinearMotion>& motions, const MountFitOptions& options);
  MountNumbers best(FreeNumbers free) const { return without(options_.parts, free); }
  /// Standard deviation of a linear function of the numbers, by omitting parts. of: its coefficients.
  double stddev(const MountNumbers& of) const;
  /// By how much the parts agree that a linear function of the numbers is larger than `best - by` says: the
  /// sum of what each part adds to it, over the root of the sum of their squares. Where it is not, and the
  /// parts err to either side alike, this exceeds x with a probability of at most exp(-x^2 / 2), whatever
  /// their sizes and their distribution are. of: its coefficients. by: that much less than the best numbers
  /// give.
  double agreement(const MountNumbers& of, double by) const;
  /// Mean logarithm of the squares at x over those at y, above the noise.
  double gain(const MountNumbers& x, const MountNumbers& y) const;

 private:
  double square(const LinearMotion& motion, const MountNumbers& x) const;
  void measure(const MountNumbers& x);
  void add_up(const std::vector<double>& weights);
  MountNumbers without(std::size_t omitted, FreeNumbers free) const;

  const std::vector<LinearMotion>& motions_;
  MountFitOptions options_;
  std::vector<Eigen::Matrix<double, 8, 8>> sums_;  ///< of each part
  std::vector<MountNumbers> right_;
  double rotation_ = 1, translation_ = 1;  ///< median squares [rad^2, m^2]
};

}  // namespace egocal::detail
