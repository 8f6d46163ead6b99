// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/mount_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "egocal/statistics/median.hpp"
#include "linear_algebra/normal_equations.hpp"

namespace egocal::detail {

using MountSum = Eigen::Matrix<double, 8, 8>;

MountFit::MountFit(const std::vector<LinearMotion>& motions, const MountFitOptions& options)
    : motions_(motions), options_(options), sums_(options.parts), right_(options.parts) {
  std::vector<double> weights(motions.size(), 1.0);
  measure(MountNumbers::Zero());
  for (int round = 0; round < options.rounds; ++round) {
    add_up(weights);
    const MountNumbers x = best(FreeNumbers::two);
    measure(x);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double w = 1 / (1 + square(motions[i], x) / options.outlier);
      weights[i] = w * w;
    }
  }
}

double MountFit::stddev(const MountNumbers& of) const {
  std::vector<double> values;
  double mean = 0;
  const auto n = static_cast<double>(options_.parts);
  for (std::size_t part = 0; part < options_.parts; ++part) {
    values.push_back(of.dot(without(part, FreeNumbers::two)));
    mean += values.back() / n;
  }
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum * (n - 1) / n);
}

double MountFit::agreement(const MountNumbers& of, double by) const {
  MountSum sum = MountSum::Zero();
  for (const MountSum& part : sums_) sum += part;
  const MountNumbers towards = solve_in_units(sum, of);
  const double size = of.dot(towards);
  if (!(size > 0)) return 0;
  // the best numbers of those where the function is less
  const MountNumbers less = best(FreeNumbers::two) - towards * (by / size);
  double total = 0, squares = 0;
  for (std::size_t part = 0; part < options_.parts; ++part) {
    const double adds = towards.dot(right_[part] - sums_[part] * less);
    total += adds;
    squares += adds * adds;
  }
  return squares > 0 ? total / std::sqrt(squares) : 0;
}

double MountFit::gain(const MountNumbers& x, const MountNumbers& y) const {
  double sum = 0;
  for (const LinearMotion& motion : motions_)
    sum += std::log((square(motion, x) + 1) / (square(motion, y) + 1));
  return sum / static_cast<double>(motions_.size());
}

/// Squared residual in units of the median squares, mean of rotation and translation.
double MountFit::square(const LinearMotion& motion, const MountNumbers& x) const {
  return 0.5 * ((motion.rotation - motion.of_rotation * x).squaredNorm() / rotation_ +
                (motion.translation - motion.of_translation * x).squaredNorm() / translation_);
}

void MountFit::measure(const MountNumbers& x) {
  constexpr double rounding = 1e-16;  // eight digits of a pose, squared
  std::vector<double> rotations, translations;
  for (const LinearMotion& motion : motions_) {
    rotations.push_back((motion.rotation - motion.of_rotation * x).squaredNorm());
    translations.push_back((motion.translation - motion.of_translation * x).squaredNorm());
  }
  rotation_ = std::max(median(std::move(rotations)), rounding);
  translation_ = std::max(median(std::move(translations)), rounding);
}

void MountFit::add_up(const std::vector<double>& weights) {
  std::fill(sums_.begin(), sums_.end(), MountSum::Zero());
  std::fill(right_.begin(), right_.end(), MountNumbers::Zero());
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const std::size_t part = i * options_.parts / motions_.size();
    add_square(sums_[part], weights[i] / rotation_, motions_[i].of_rotation);
    add_square(sums_[part], weights[i] / translation_, motions_[i].of_translation);
    add_product(right_[part], weights[i] / rotation_, motions_[i].of_rotation, motions_[i].rotation);
    add_product(right_[part], weights[i] / translation_, motions_[i].of_translation, motions_[i].translation);
  }
}

/// The numbers without one part; of all for options_.parts.
MountNumbers MountFit::without(std::size_t omitted, FreeNumbers free) const {
  MountSum sum = MountSum::Zero();
  MountNumbers right = MountNumbers::Zero();
  for (std::size_t part = 0; part < options_.parts; ++part) {
    if (part == omitted) continue;
    sum += sums_[part];
    right += right_[part];
  }
  const auto fix = [&](int number) {
    sum.row(number).setZero();
    sum.col(number).setZero();
    right[number] = 0;
  };
  if (free == FreeNumbers::one_for_both) {
    sum.col(first_number) += sum.col(second_number).eval();
    sum.row(first_number) += sum.row(second_number).eval();
    right[first_number] += right[second_number];
  }
  if (free == FreeNumbers::none) fix(first_number);
  if (free != FreeNumbers::two) fix(second_number);
  MountNumbers x = solve_in_units(sum, right);
  if (free == FreeNumbers::one_for_both) x[second_number] = x[first_number];
  return x;
}

}  // namespace egocal::detail
