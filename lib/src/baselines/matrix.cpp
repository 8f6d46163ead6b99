// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/SVD>
#include <cmath>

#include "baselines/usable.hpp"
#include "egocal/baselines/baselines.hpp"
#include "linear_algebra/normal_equations.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "solvers/lmi.hpp"

namespace egocal {
namespace {

// The unknowns of [8]: x = (vec R column by column, y = 1), after the translation is eliminated.
using Matrix10d = Eigen::Matrix<double, 10, 10>;
using Vector10d = Eigen::Matrix<double, 10, 1>;
using Matrix13d = Eigen::Matrix<double, 13, 13>;
constexpr int homogeneous = 9;        // index of the number 1 behind the nine entries of R
constexpr double rank_limit = 1e-13;  // of eigenvalues of the translations, to the largest: rounding

int entry(int row, int column) {
  return 3 * column + row;
}

/// Six row and six column orthonormality constraints, nine of handedness, one of homogenisation: 22. The
/// traces of R R' and R'R are the same number, so one diagonal one is implied by the others and omitted: 21
/// independent ones.
Lmi<10, 21> rotation_constraints() {
  Lmi<10, 21> lmi;
  std::size_t next = 0;
  const auto add = [&](const Matrix10d& A, double b) {
    lmi.A[next] = 0.5 * (A + A.transpose());
    lmi.b[static_cast<Eigen::Index>(next)] = b;
    ++next;
  };
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      Matrix10d columns = Matrix10d::Zero(), rows = Matrix10d::Zero();
      for (int k = 0; k < 3; ++k) {
        columns(entry(k, i), entry(k, j)) += 1;
        rows(entry(i, k), entry(j, k)) += 1;
      }
      add(columns, i == j ? 1 : 0);
      if (i != 2 || j != 2) add(rows, i == j ? 1 : 0);
    }
  }
  for (int i = 0; i < 3; ++i) {
    // column i x column j = y column k
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    for (int row = 0; row < 3; ++row) {
      const int s = (row + 1) % 3, t = (row + 2) % 3;
      Matrix10d A = Matrix10d::Zero();
      A(entry(s, i), entry(t, j)) += 1;
      A(entry(t, i), entry(s, j)) -= 1;
      A(homogeneous, entry(row, k)) -= 1;
      add(A, 0);
    }
  }
  Matrix10d unit = Matrix10d::Zero();
  unit(homogeneous, homogeneous) = 1;
  add(unit, 1);
  return lmi;
}

/// The cost matrix of (vec R, 1, t): |R_a R - R R_b|^2 + |R_a t + t_a - R t_b - t|^2.
Matrix13d cost_of(const std::vector<MotionPair>& pairs) {
  Matrix13d sum = Matrix13d::Zero();
  double weight = 0;
  for (const MotionPair& pair : pairs) {
    const Pose a = to_pose(pair.a), b = to_pose(pair.b);
    const Eigen::Matrix3d R_a = a.rotation.toRotationMatrix(), R_b = b.rotation.toRotationMatrix();
    Eigen::Matrix<double, 12, 13> M = Eigen::Matrix<double, 12, 13>::Zero();
    for (int c = 0; c < 3; ++c) {
      M.block<3, 3>(3 * c, 3 * c) += R_a;
      for (int k = 0; k < 3; ++k) M.block<3, 3>(3 * c, 3 * k) -= R_b(k, c) * Eigen::Matrix3d::Identity();
      M.block<3, 3>(9, 3 * c) = -b.translation[c] * Eigen::Matrix3d::Identity();
    }
    M.block<3, 1>(9, homogeneous) = a.translation;
    M.block<3, 3>(9, 10) = R_a - Eigen::Matrix3d::Identity();
    detail::add_square(sum, pair.eta, M);
    weight += pair.eta;
  }
  return sum / weight;
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs[2] = -1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Vector10d homogenised(const Eigen::Matrix3d& R) {
  Vector10d x;
  x << Eigen::Map<const Eigen::Matrix<double, 9, 1>>(R.data()), 1;
  return x;
}

}  // namespace

BaselineAnswer solve_matrix(std::span<const MotionPair> pairs) {
  BaselineAnswer answer;
  const std::vector<MotionPair> usable = usable_pairs(pairs);
  if (usable.empty()) {
    answer.note = "no motion pairs";
    return answer;
  }
  const Matrix13d full = cost_of(usable);
  const Eigen::Matrix3d H = full.bottomRightCorner<3, 3>();
  const Eigen::Matrix<double, 3, 10> K = full.bottomLeftCorner<3, 10>();
  // the shortest translation where H does not determine it
  const detail::SymmetricEigen<3> of_H = detail::symmetric_eigen<3>(H);
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i)
    if (of_H.values[i] > rank_limit * of_H.values[2])
      inverse += of_H.vectors.col(i) * of_H.vectors.col(i).transpose() / of_H.values[i];
  const Eigen::Matrix<double, 3, 10> t_of_x = -(inverse * K);
  Matrix10d C = full.topLeftCorner<10, 10>() + K.transpose() * t_of_x;
  C = 0.5 * (C + C.transpose()).eval();
  const double size = C.trace();
  if (!(size > 1e-300) || !std::isfinite(size)) {
    answer.note = "the sensors do not move";
    return answer;
  }

  static const Lmi<10, 21> constraints = rotation_constraints();
  Lmi<10, 21> lmi = constraints;
  lmi.C = C / size;
  LmiPoint<10, 21> start;
  // the mean of [vec R; 1][vec R; 1]' over all rotations: inside the cone and on every constraint
  start.X = Matrix10d::Identity() / 3;
  start.X(homogeneous, homogeneous) = 1;
  start.Z = Matrix10d::Identity();
  start.y.setZero();
  const LmiResult<10, 21> result = solve_lmi(lmi, start, 1e-14, 200);

  // candidates: the null vector of Z, and the principal one of X where the former has no homogeneous part
  Matrix10d Z = lmi.C;
  for (int i = 0; i < 21; ++i) Z -= result.point.y[i] * lmi.A[std::size_t(i)];
  const detail::SymmetricEigen<10> of_Z = detail::symmetric_eigen<10>(Z),
                                   of_X = detail::symmetric_eigen<10>(result.point.X);
  double best = INFINITY;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (const Vector10d& x : {Vector10d(of_Z.vectors.col(0)), Vector10d(of_X.vectors.col(9)),
                             Vector10d(result.point.X.col(homogeneous))}) {
    if (!(std::abs(x[homogeneous]) > 1e-9)) continue;
    const Vector10d unit = x / x[homogeneous];
    const Eigen::Matrix3d candidate = nearest_rotation(Eigen::Map<const Eigen::Matrix3d>(unit.data()));
    const Vector10d point = homogenised(candidate);
    const double value = point.dot(lmi.C * point);
    if (value < best) {
      best = value;
      R = candidate;
    }
  }
  if (!std::isfinite(best)) {
    answer.note = "no rotation could be recovered";
    return answer;
  }
  Pose T;
  T.rotation = Eigen::Quaterniond(R).normalized();
  T.translation = t_of_x * homogenised(R);
  answer.T_a_b = to_dual_quaternion(T);
  answer.gap = std::max(0.0, best - lmi.b.dot(result.point.y)) * size;
  answer.certified = answer.gap <= 1e-8 * size;
  answer.valid = of_H.values[0] > rank_limit * of_H.values[2];
  if (!answer.valid) {
    answer.note = "the motions turn about fewer than two axes: part of the translation is unknown";
  } else if (!answer.certified) {
    answer.note = "its duality gap is open";
  }
  return answer;
}

}  // namespace egocal
