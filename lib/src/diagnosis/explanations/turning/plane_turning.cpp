// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/turning/plane_turning.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "linear_algebra/symmetric_eigen.hpp"

namespace egocal::detail {

namespace {

/// Sine of half the angle, about the axis. Those of both sensors are related by the rotation between them.
Eigen::Vector3d half_turn(const DualQuaternion& motion) {
  return motion.real.tail<3>();
}

/// Sums over the motions of one part of the drive.
struct TurnSums {
  Eigen::Matrix3d squares_a = Eigen::Matrix3d::Zero(), squares_b = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();          ///< a b', without outliers
  Eigen::Matrix3d weighted_squares = Eigen::Matrix3d::Zero();  ///< b b', without outliers
  double weighted_a = 0;                                       ///< |a|^2, without outliers

  TurnSums& operator+=(const TurnSums& other) {
    squares_a += other.squares_a;
    squares_b += other.squares_b;
    products += other.products;
    weighted_squares += other.weighted_squares;
    weighted_a += other.weighted_a;
    return *this;
  }
};

/// The sum of all parts except one. Where `without` is no part, it is the sum of all.
TurnSums sum_without(const std::vector<TurnSums>& parts, std::size_t without) {
  TurnSums sum;
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (k != without) sum += parts[k];
  return sum;
}

/// Standard deviation by the jack-knife over n parts. sum: of the squared changes that omitting each makes.
double jackknife(double sum, std::size_t parts) {
  const auto n = static_cast<double>(parts);
  return std::sqrt(sum * (n - 1) / n);
}

double angle_between(const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  return std::atan2(x.cross(y).norm(), x.dot(y));
}

Eigen::Vector3d main_axis(const Eigen::Matrix3d& squares, const Eigen::Vector3d& towards, double* ratio) {
  const SymmetricEigen<3> eigen = symmetric_eigen<3>(squares);
  if (ratio && eigen.values[2] > 0)
    *ratio = eigen.values[1] > 0 ? eigen.values[2] / eigen.values[1] : INFINITY;
  const Eigen::Vector3d axis = eigen.vectors.col(2);
  return axis.dot(towards) < 0 ? Eigen::Vector3d(-axis) : axis;
}

AxisBesideNormal axis_of(const std::vector<TurnSums>& parts, Eigen::Matrix3d TurnSums::*squares,
                         const Eigen::Vector3d& normal) {
  AxisBesideNormal result;
  result.axis = main_axis(sum_without(parts, parts.size()).*squares, normal, &result.ratio);
  result.off = angle_between(result.axis, normal);
  double sum = 0;
  for (std::size_t k = 0; k < parts.size(); ++k)
    sum += (main_axis(sum_without(parts, k).*squares, result.axis, nullptr) - result.axis).squaredNorm();
  result.stddev = jackknife(sum, parts.size());
  return result;
}

/// The rotation R near the given one that makes the sum of |a - R b|^2 least, by Newton's steps. About an
/// axis that nearly all turns share it stays as given: there it is the noise that would turn it.
Eigen::Matrix3d turned_alike(const TurnSums& sums, Eigen::Matrix3d R) {
  constexpr int steps = 6;  // to rounding, from any start that is right to 0.1 rad
  for (int step = 0; step < steps; ++step) {
    const Eigen::Matrix3d squares = R * sums.weighted_squares * R.transpose(),
                          products = sums.products * R.transpose();
    const double trace = squares.trace();
    if (!(trace > 0)) return R;
    constexpr double held = 0.01;  // of the trace; the other directions converge by a hundredth a step
    const Eigen::Matrix3d M = (1 + held) * trace * Eigen::Matrix3d::Identity() - squares;
    // the sum of (R b) x a, from the products a (R b)'
    const Eigen::Vector3d moment(products(2, 1) - products(1, 2), products(0, 2) - products(2, 0),
                                 products(1, 0) - products(0, 1));
    const Eigen::Vector3d change = M.inverse() * moment;
    if (!change.allFinite() || !(change.norm() < 1)) return R;
    R = rotation_exp(change).toRotationMatrix() * R;
  }
  return R;
}

NormalsApart apart_by_turns(const std::vector<TurnSums>& parts, const Eigen::Matrix3d& R_best,
                            const Eigen::Vector3d& normal_a, const Eigen::Vector3d& normal_b) {
  const TurnSums all = sum_without(parts, parts.size());
  const Eigen::Matrix3d R = turned_alike(all, R_best);
  const double size = std::sqrt(all.weighted_a * all.weighted_squares.trace());
  const double alike = size > 0 ? all.products.cwiseProduct(R).sum() / size : 0;
  const double angle = angle_between(R * normal_b, normal_a);
  // of the angle, not of the direction: how both sensors are turned about the axis may be unknown
  double sum = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Eigen::Matrix3d without = turned_alike(sum_without(parts, k), R);
    const double change = angle_between(without * normal_b, normal_a) - angle;
    sum += change * change;
  }
  return {angle, jackknife(sum, parts.size()), alike};
}

}  // namespace

PlaneTurning plane_turning(const Explained& given, const Eigen::Vector3d& normal_a,
                           const Eigen::Vector3d& normal_b, std::size_t blocks) {
  const std::vector<Motion>& all = given.motions.all;
  std::vector<TurnSums> parts(std::min(blocks, all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    TurnSums& part = parts[i * parts.size() / all.size()];
    const Eigen::Vector3d a = half_turn(all[i].a), b = half_turn(all[i].b);
    const double weight = given.fit.weights[i];
    part.squares_a += a * a.transpose();
    part.squares_b += b * b.transpose();
    part.products += weight * a * b.transpose();
    part.weighted_squares += weight * b * b.transpose();
    part.weighted_a += weight * a.squaredNorm();
  }
  const Eigen::Matrix3d R = to_pose(given.fit.T).rotation.toRotationMatrix();
  return {axis_of(parts, &TurnSums::squares_a, normal_a), axis_of(parts, &TurnSums::squares_b, normal_b),
          apart_by_turns(parts, R, normal_a, normal_b)};
}

}  // namespace egocal::detail
