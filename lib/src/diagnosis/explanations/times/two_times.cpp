// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/two_times.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/motions/changed_motions.hpp"
#include "linear_algebra/cross_matrix.hpp"
#include "linear_algebra/normal_equations.hpp"
#include "statistics/median.hpp"

namespace egocal::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using TwoTimesSum = Eigen::Matrix<double, 8, 8>;

StreamOfTwoTimes::StreamOfTwoTimes(const Instants& instants, const Explained& given, Side side,
                                   const TwoTimesOptions& options)
    : instants_(instants),
      side_(side),
      T_(side == Side::b ? to_pose(given.fit.T) : inverse(to_pose(given.fit.T))),
      R_(T_.rotation.toRotationMatrix()),
      span_(static_cast<std::size_t>(given.motions.stride)),
      reach_(std::clamp<std::size_t>(
          static_cast<std::size_t>(std::ceil(0.5 * options.least_span / std::max(instants.period, 1e-6))), 1,
          options.most_instants)),
      longest_(options.across_a_gap * static_cast<double>(span_ + 2 * reach_) * instants.period) {
  Matrix3d turns = Matrix3d::Zero();
  for (const Motion& motion : given.motions.all) {
    const Vector3d turn = rotation_log(to_pose(side == Side::b ? motion.b : motion.a).rotation);
    turns += turn * turn.transpose();
  }
  const Vector3d axis = Eigen::SelfAdjointEigenSolver<Matrix3d>(turns).eigenvectors().col(2);
  about_axis_ = axis * axis.transpose();
}

bool StreamOfTwoTimes::has(std::size_t i) const {
  const std::size_t last = i + span_ + reach_;
  return i >= reach_ && last < instants_.size() &&
         instants_.time(last) - instants_.time(i - reach_) <= longest_;
}

std::vector<TwoTimesMotion> StreamOfTwoTimes::motions(const Explained& given, std::size_t most) const {
  const std::vector<std::size_t> begins = begins_of(instants_, given.motions);
  const std::size_t n = std::min(begins.size(), most);
  std::vector<TwoTimesMotion> motions;
  for (std::size_t k = 0; k < n; ++k)
    if (const std::size_t i = begins[k * begins.size() / n]; has(i)) motions.push_back(motion(i));
  return motions;
}

/// With rotations R(t + r) and positions p(t + s) in place of R(t) and p(t), and the mounting moved by a turn
/// x and a shift y, R_a T = T R_b is linear in r, s, x and y. Turning rates are w, velocities v:
///   log(R_T' R_a R_T R_b') = (1 - R_b) x + r (w - R_b w'),
///   R_T' (R_a t + t_a - t) - t_b = (1 - R_b) y - t_b x x + r w x t_b - s R' (v' - v),
/// where ' at w and v is the end of the motion, and R' turns from the stream's world to its begin.
TwoTimesMotion StreamOfTwoTimes::motion(std::size_t i) const {
  const Poses from = at(i), to = at(i + span_);
  const Rates rates_from = rates(i), rates_to = rates(i + span_);
  const Pose other = inverse(from.other) * to.other, own = inverse(from.own) * to.own;
  const Matrix3d turned = own.rotation.toRotationMatrix(), apart = Matrix3d::Identity() - turned;
  TwoTimesMotion result;
  result.rotation =
      rotation_log(T_.rotation.conjugate() * other.rotation * T_.rotation * own.rotation.conjugate());
  result.translation =
      R_.transpose() * (other.rotation * T_.translation + other.translation - T_.translation) -
      own.translation;
  result.of_rotation << apart, Matrix3d::Zero(), rates_from.turning - turned * rates_to.turning,
      Vector3d::Zero();
  result.of_translation << -cross_matrix(own.translation), apart, rates_from.turning.cross(own.translation),
      from.own.rotation.conjugate() * (rates_from.velocity - rates_to.velocity);
  return result;
}

DualQuaternion StreamOfTwoTimes::T_a_b(const TwoTimes& x) const {
  const Pose T{T_.rotation * rotation_exp(x.head<3>()), T_.translation + R_ * x.segment<3>(3)};
  return to_dual_quaternion(side_ == Side::b ? T : inverse(T));
}

StreamOfTwoTimes::Poses StreamOfTwoTimes::at(std::size_t i) const {
  const PosePair poses = instants_.at(i);
  return side_ == Side::b ? Poses{to_pose(poses.b), to_pose(poses.a)}
                          : Poses{to_pose(poses.a), to_pose(poses.b)};
}

StreamOfTwoTimes::Rates StreamOfTwoTimes::rates(std::size_t i) const {
  const Poses from = at(i - reach_), to = at(i + reach_);
  const double seconds = instants_.time(i + reach_) - instants_.time(i - reach_);
  const Vector3d by_own = rotation_log(from.own.rotation.conjugate() * to.own.rotation),
                 by_other =
                     R_.transpose() * rotation_log(from.other.rotation.conjugate() * to.other.rotation);
  return {about_axis_ * (by_own + by_other) / (2 * seconds),
          (to.own.translation - from.own.translation) / seconds};
}

TwoTimesFit::TwoTimesFit(const std::vector<TwoTimesMotion>& motions, const TwoTimesOptions& options)
    : motions_(motions), options_(options), sums_(options.parts), right_(options.parts) {
  std::vector<double> weights(motions.size(), 1.0);
  measure(TwoTimes::Zero());
  for (int round = 0; round < options.rounds; ++round) {
    add_up(weights);
    const TwoTimes x = best(FreeTimes::two);
    measure(x);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double w = 1 / (1 + square(motions[i], x) / options.outlier);
      weights[i] = w * w;
    }
  }
}

double TwoTimesFit::stddev(const TwoTimes& of) const {
  std::vector<double> values;
  double mean = 0;
  const auto n = static_cast<double>(options_.parts);
  for (std::size_t part = 0; part < options_.parts; ++part) {
    values.push_back(of.dot(without(part, FreeTimes::two)));
    mean += values.back() / n;
  }
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum * (n - 1) / n);
}

double TwoTimesFit::gain(const TwoTimes& x, const TwoTimes& y) const {
  double sum = 0;
  for (const TwoTimesMotion& motion : motions_)
    sum += std::log((square(motion, x) + 1) / (square(motion, y) + 1));
  return sum / static_cast<double>(motions_.size());
}

/// In units of the median squares, mean of rotation and translation.
double TwoTimesFit::square(const TwoTimesMotion& motion, const TwoTimes& x) const {
  return 0.5 * ((motion.rotation - motion.of_rotation * x).squaredNorm() / rotation_ +
                (motion.translation - motion.of_translation * x).squaredNorm() / translation_);
}

void TwoTimesFit::measure(const TwoTimes& x) {
  constexpr double rounding = 1e-16;  // eight digits of a pose, squared
  std::vector<double> rotations, translations;
  for (const TwoTimesMotion& motion : motions_) {
    rotations.push_back((motion.rotation - motion.of_rotation * x).squaredNorm());
    translations.push_back((motion.translation - motion.of_translation * x).squaredNorm());
  }
  rotation_ = std::max(median(std::move(rotations)), rounding);
  translation_ = std::max(median(std::move(translations)), rounding);
}

void TwoTimesFit::add_up(const std::vector<double>& weights) {
  std::fill(sums_.begin(), sums_.end(), TwoTimesSum::Zero());
  std::fill(right_.begin(), right_.end(), TwoTimes::Zero());
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const std::size_t part = i * options_.parts / motions_.size();
    add_square(sums_[part], weights[i] / rotation_, motions_[i].of_rotation);
    add_square(sums_[part], weights[i] / translation_, motions_[i].of_translation);
    add_product(right_[part], weights[i] / rotation_, motions_[i].of_rotation, motions_[i].rotation);
    add_product(right_[part], weights[i] / translation_, motions_[i].of_translation, motions_[i].translation);
  }
}

/// The numbers without one part; of all for options_.parts.
TwoTimes TwoTimesFit::without(std::size_t omitted, FreeTimes free) const {
  TwoTimesSum sum = TwoTimesSum::Zero();
  TwoTimes right = TwoTimes::Zero();
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
  if (free == FreeTimes::one_for_both) {
    sum.col(time_of_rotations) += sum.col(time_of_positions).eval();
    sum.row(time_of_rotations) += sum.row(time_of_positions).eval();
    right[time_of_rotations] += right[time_of_positions];
  }
  if (free == FreeTimes::none) fix(time_of_rotations);
  if (free != FreeTimes::two) fix(time_of_positions);
  // each number in a unit of its own; what is not shown stays as it is
  TwoTimes unit = TwoTimes::Zero();
  for (int i = 0; i < unit.size(); ++i)
    if (sum(i, i) > 0) unit[i] = 1 / std::sqrt(sum(i, i));
  TwoTimesSum scaled = unit.asDiagonal() * sum * unit.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  TwoTimes x = unit.cwiseProduct(TwoTimes(solve_symmetric(scaled, unit.cwiseProduct(right))));
  if (free == FreeTimes::one_for_both) x[time_of_positions] = x[time_of_rotations];
  return x;
}

}  // namespace egocal::detail
