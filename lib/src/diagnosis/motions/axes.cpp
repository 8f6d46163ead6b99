// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/axes.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "diagnosis/motions/reading.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/statistics/median.hpp"
#include "linear_algebra/cross_matrix.hpp"
#include "linear_algebra/normal_equations.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;
using Rows = Eigen::Matrix<double, 3, 12>;
using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;
using TurnRows = Eigen::Matrix<double, 3, 7>;

/// One motion of the right stream s, and of the wrong one w as its file has it.
struct Step {
  QuaternionVector s, w;  ///< rotations
  Matrix3d R_s, R_world;  ///< rotation of s; orientation of w at the begin of the motion
  Vector3d t_s, d;        ///< translation of s in its own frame; of w in its file's axes
  double weight = 1;
  Matrix3d R_world_s = Matrix3d::Identity();  ///< of s, where both streams are wrong,
  Vector3d d_s = Vector3d::Zero();            ///< and its translation in its file's axes
};

Matrix3d matrix(const QuaternionVector& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

QuaternionVector rotation(const DualQuaternion& pose, bool conjugated) {
  return conjugated ? quaternion_conjugate(pose.real) : pose.real;
}

/// Rotation from one pose to the other.
QuaternionVector turn(const DualQuaternion& from, const DualQuaternion& to, bool conjugated) {
  const QuaternionVector q =
      quaternion_product(quaternion_conjugate(rotation(from, conjugated)), rotation(to, conjugated));
  return q[0] < 0 ? QuaternionVector(-q) : q;
}

/// Takes the pairs of poses at both ends of motions, most of them at most, that no gap stretches.
template <typename Take>
void for_each_motion(const Instants& instants, int stride, std::size_t most, const DiagnosisOptions& options,
                     const Take& take) {
  const std::size_t n = instants.size(), span = static_cast<std::size_t>(stride);
  if (n <= span) return;
  const std::size_t each = std::max<std::size_t>(1, (n - span) / most);
  for (std::size_t i = 0; i + span < n; i += each) {
    const std::size_t k = i + span;
    if (instants.time(k) - instants.time(i) <= options.motions.most_stretched * stride * instants.period)
      take(instants.at(i), instants.at(k));
  }
}

std::vector<Step> steps_of(const Instants& instants, Side wrong, bool conjugated, int stride,
                           std::size_t most, const DiagnosisOptions& options) {
  std::vector<Step> steps;
  for_each_motion(instants, stride, most, options, [&](const PosePair& from, const PosePair& to) {
    const bool in_b = wrong == Side::b;
    const DualQuaternion s = canonical_sign(in_b ? conjugate(from.a) * to.a : conjugate(from.b) * to.b);
    const DualQuaternion w0 = in_b ? from.b : from.a;
    const DualQuaternion w1 = in_b ? to.b : to.a;
    const QuaternionVector r0 = rotation(w0, conjugated), w = turn(w0, w1, conjugated);
    if (std::max(rotation_angle(s), rotation_angle(w)) > options.motions.most_rotation) return;
    steps.push_back(
        {s.real, w, matrix(s.real), matrix(r0), position_of(s), position_of(w1) - position_of(w0), 1});
  });
  return steps;
}

/// Motions of both streams, read alike: a is s, b is w.
std::vector<Step> steps_of_both(const Instants& instants, bool conjugated, int stride, std::size_t most,
                                const DiagnosisOptions& options) {
  std::vector<Step> steps;
  for_each_motion(instants, stride, most, options, [&](const PosePair& from, const PosePair& to) {
    const QuaternionVector s = turn(from.a, to.a, conjugated), w = turn(from.b, to.b, conjugated);
    if (2 * std::acos(std::min({1.0, s[0], w[0]})) > options.motions.most_rotation) return;
    steps.push_back({s, w, matrix(s), matrix(rotation(from.b, conjugated)), Vector3d::Zero(),
                     position_of(to.b) - position_of(from.b), 1, matrix(rotation(from.a, conjugated)),
                     position_of(to.a) - position_of(from.a)});
  });
  return steps;
}

/// Brings the translations of w to a unit in which both streams travel as far: columns of unlike size would
/// spoil the sums.
void with_like_lengths(std::vector<Step>& steps) {
  double right = 0, wrong = 0;
  for (const Step& step : steps) {
    right += step.t_s.norm();
    wrong += step.d.norm();
  }
  if (!(right > 0) || !(wrong > 0)) return;
  for (Step& step : steps) step.d *= right / wrong;
}

/// Weights that outliers lose, from squares in the order of the steps.
void reweight(std::vector<Step>& steps, const std::vector<double>& squares, double inlier) {
  const double typical = std::max(median(squares), 1e-300);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double w = 1 / (1 + squares[i] / (inlier * typical));
    steps[i].weight = w * w;
  }
}

/// Orientation of the wrong sensor in the right one from rotations alone: |s q - q w|^2, reweighted.
Matrix3d orientation(std::vector<Step>& steps, const RobustFitOptions& options) {
  QuaternionVector q = QuaternionVector::UnitX();
  for (int round = 0; round < options.rounds; ++round) {
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    for (const Step& step : steps) {
      const Eigen::Matrix4d M = left_matrix(step.s) - right_matrix(step.w);
      sum += step.weight * M.transpose() * M;
    }
    q = symmetric_eigen<4>(sum).vectors.col(0);
    std::vector<double> squares;
    squares.reserve(steps.size());
    for (const Step& step : steps)
      squares.push_back((quaternion_product(step.s, q) - quaternion_product(q, step.w)).squaredNorm());
    reweight(steps, squares, options.inlier);
  }
  return matrix(q);
}

/// (R_s - 1) t - R R_world' W d = -t_s, linear in t and the columns of W.
Rows rows_of(const Step& step, const Matrix3d& R) {
  Rows rows;
  rows.leftCols<3>() = step.R_s - Matrix3d::Identity();
  const Matrix3d turned = -R * step.R_world.transpose();
  for (int column = 0; column < 3; ++column) rows.middleCols<3>(3 + 3 * column) = step.d[column] * turned;
  return rows;
}

Matrix3d linear_map(std::vector<Step>& steps, const Matrix3d& R, const RobustFitOptions& options) {
  Vector12d x = Vector12d::Zero();
  for (int round = 0; round < options.rounds; ++round) {
    Matrix12d A = Matrix12d::Zero();
    Vector12d g = Vector12d::Zero();
    for (const Step& step : steps) {
      const Rows rows = rows_of(step, R);
      add_square(A, step.weight, rows);
      add_product(g, -step.weight, rows, step.t_s);
    }
    // what the drive does not show stays zero, and is completed below
    A.diagonal().array() += 1e-6 * A.trace() / 12 + 1e-300;
    x = solve_symmetric(A, g);
    std::vector<double> squares;
    squares.reserve(steps.size());
    for (const Step& step : steps) squares.push_back((rows_of(step, R) * x + step.t_s).squaredNorm());
    reweight(steps, squares, options.inlier);
  }
  return Eigen::Map<const Matrix3d>(x.data() + 3);
}

/// The map of the positions of both streams, W: (R_s - 1) t + R_world_s' W d_s - R R_world' W d = 0 has a
/// solution up to a factor, of both t and W. It is the one that explains most of what W makes of the
/// positions.
Matrix3d common_map(std::vector<Step>& steps, const Matrix3d& R, const RobustFitOptions& options) {
  Vector12d x = Vector12d::Zero();
  const auto rows_of_both = [&R](const Step& step) {
    Rows rows;
    rows.leftCols<3>() = step.R_s - Matrix3d::Identity();
    const Matrix3d turned = -R * step.R_world.transpose(), back = step.R_world_s.transpose();
    for (int column = 0; column < 3; ++column)
      rows.middleCols<3>(3 + 3 * column) = step.d[column] * turned + step.d_s[column] * back;
    return rows;
  };
  for (int round = 0; round < options.rounds; ++round) {
    Matrix12d A = Matrix12d::Zero();
    Matrix3d travelled = Matrix3d::Zero();
    for (const Step& step : steps) {
      const Rows rows = rows_of_both(step);
      add_square(A, step.weight, rows);
      travelled += step.weight * (step.d * step.d.transpose() + step.d_s * step.d_s.transpose());
    }
    // a direction that nothing travels along stays zero, and is completed below
    A.diagonal().array() += 1e-4 * travelled.trace() + 1e-300;
    travelled.diagonal().array() += 1e-6 * travelled.trace() + 1e-300;
    // without t, and with lengths that are those of what W makes of the positions
    const SymmetricEigen<Eigen::Dynamic> axes = symmetric_eigen<Eigen::Dynamic>(travelled);
    const Eigen::MatrixXd whiten = axes.vectors * axes.values.cwiseSqrt().cwiseInverse().asDiagonal();
    const Eigen::MatrixXd lever = -solve_symmetric(A.topLeftCorner<3, 3>(), A.topRightCorner<3, 9>());
    const Eigen::MatrixXd inner = A.bottomRightCorner<9, 9>() + A.bottomLeftCorner<9, 3>() * lever;
    Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(9, 9);
    for (int i = 0; i < 9; ++i)
      for (int k = 0; k < 9; ++k)
        rest.block<3, 3>(3 * (i / 3), 3 * (k / 3)) +=
            whiten(i % 3, i / 3) * whiten(k % 3, k / 3) * inner.block<3, 3>(3 * (i % 3), 3 * (k % 3));
    const Eigen::VectorXd whitened = symmetric_eigen<Eigen::Dynamic>(rest).vectors.col(0);
    for (int column = 0; column < 3; ++column) {
      x.segment<3>(3 + 3 * column).setZero();
      for (int k = 0; k < 3; ++k)
        x.segment<3>(3 + 3 * column) += whiten(column, k) * whitened.segment<3>(3 * k);
    }
    x.head<3>() = lever * x.tail<9>();
    std::vector<double> squares;
    squares.reserve(steps.size());
    for (const Step& step : steps) squares.push_back((rows_of_both(step) * x).squaredNorm());
    reweight(steps, squares, options.inlier);
  }
  const Matrix3d W = Eigen::Map<const Matrix3d>(x.data() + 3);
  return W.sum() < 0 ? Matrix3d(-W) : W;  // either sign: columns are read with few minus signs
}

/// Orthogonal matrices nearest to W: two where the drive shows two directions only, none where it shows
/// fewer.
std::vector<Matrix3d> nearest_orthogonal(const Matrix3d& W) {
  if (!W.allFinite()) return {};
  const Eigen::JacobiSVD<Matrix3d> svd(W, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d& sizes = svd.singularValues();
  if (!(sizes[1] > 0.3 * sizes[0])) return {};
  const Matrix3d &U = svd.matrixU(), &V = svd.matrixV();
  const Matrix3d one = U * V.transpose();
  if (sizes[2] > 0.3 * sizes[0]) return {one};
  return {one, U * Vector3d(1, 1, -1).asDiagonal() * V.transpose()};
}

/// Whether the positions of one stream are wrong, or those of both.
enum class WrongAxes { of_one, of_both };

/// The orthogonal matrix, mirrored as W is, that suits the steps best: from W, which has six unknowns more
/// and what noise makes of them. Gauss-Newton for it, the lever arm t, and the scale c of w, which differs
/// from what like lengths leave of it where the sensors turn: (R_s - 1) t + t_s + R_world_s' W d_s - c R
/// R_world' W d = 0. Where both streams are wrong it stays: both are of one program.
Matrix3d refined(const std::vector<Step>& steps, const Matrix3d& R, Matrix3d W, WrongAxes wrong, int rounds) {
  double scale = 1;
  for (int round = 0; round < rounds; ++round) {
    Matrix7d A = Matrix7d::Zero();
    Vector7d g = Vector7d::Zero();
    for (const Step& step : steps) {
      const Matrix3d of_s = step.R_world_s.transpose() * W, of_w = scale * R * step.R_world.transpose() * W;
      const Vector3d residual = step.t_s + of_s * step.d_s - of_w * step.d;
      TurnRows J;
      J.leftCols<3>() = step.R_s - Matrix3d::Identity();
      J.middleCols<3>(3) = of_w * cross_matrix(step.d) - of_s * cross_matrix(step.d_s);
      J.rightCols<1>() = -of_w * step.d;
      add_square(A, step.weight, J);
      add_product(g, -step.weight, J, residual);
    }
    A.diagonal().head<3>().array() += 1e-6 * A.diagonal().head<3>().sum() + 1e-300;
    A.diagonal().segment<3>(3).array() += 1e-6 * A.diagonal().segment<3>(3).sum() + 1e-300;
    A(6, 6) += 1e-6 * A(6, 6) + 1e-300;
    Vector7d x = Vector7d::Zero();  // t, the turn of W, and the logarithm of c
    if (wrong == WrongAxes::of_one)
      x = solve_symmetric(A, g);
    else
      x.head<6>() = solve_symmetric(A.topLeftCorner<6, 6>(), g.head<6>());
    if (!x.allFinite()) break;
    W = W * rotation_exp(x.segment<3>(3)).toRotationMatrix();
    scale *= std::exp(x[6]);
  }
  return W;
}

/// The signed permutation within about 40 degrees, if there is one: noise of 10 % turns what is found by 30.
std::optional<Matrix3d> nearest_permutation(const Matrix3d& W) {
  Matrix3d result = Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) {
    Eigen::Index column = 0;
    if (W.row(row).cwiseAbs().maxCoeff(&column) < 0.77) return std::nullopt;
    result(row, column) = W(row, column) < 0 ? -1 : 1;
  }
  if (std::abs(std::abs(result.determinant()) - 1) > 1e-12) return std::nullopt;
  return result;
}

}  // namespace

bool is_permutation(const Matrix3d& axes) {
  return (axes.array() == axes.array().round()).all();
}

Vector3d turn_of(const Matrix3d& axes) {
  return rotation_log(Rotation(axes.determinant() < 0 ? Matrix3d(-axes) : axes));
}

std::vector<PoseReading> inverse_rotation_readings() {
  PoseReading inverse_rotation, inverse_position;
  inverse_rotation.conjugate = true;
  inverse_position.invert = inverse_position.conjugate = true;
  return {inverse_rotation, inverse_position};
}

std::vector<PoseReading> common_axes_readings(const Instants& instants, int stride, std::size_t most,
                                              const DiagnosisOptions& options) {
  std::vector<PoseReading> readings = inverse_rotation_readings();
  for (const bool conjugated : {false, true}) {
    std::vector<Step> steps = steps_of_both(instants, conjugated, stride, most, options);
    if (steps.size() < options.motions.least) continue;
    const Matrix3d R = orientation(steps, options.fit);
    for (const Matrix3d& W : nearest_orthogonal(common_map(steps, R, options.fit)))
      for (const std::optional<Matrix3d>& axes :
           {nearest_permutation(W),
            std::optional(refined(steps, R, W, WrongAxes::of_both, options.fit.rounds))}) {
        // mirrored at the origin both streams have the same motions, but for the sign of the lever arm
        if (!axes || axes->isIdentity(1e-12) || (-*axes).isIdentity(1e-12)) continue;
        PoseReading reading;
        reading.axes = *axes;
        reading.conjugate = conjugated;
        readings.push_back(reading);
      }
  }
  return readings;
}

std::vector<PoseReading> axes_readings(const Instants& instants, Side wrong, int stride, std::size_t most,
                                       const DiagnosisOptions& options) {
  std::vector<PoseReading> readings;
  const auto add = [&](const Matrix3d& axes, bool conjugated) {
    PoseReading reading;
    reading.axes = axes;
    reading.conjugate = conjugated;
    if (conjugated || !axes.isIdentity(1e-12)) readings.push_back(reading);
  };
  for (const bool conjugated : {false, true}) {
    std::vector<Step> steps = steps_of(instants, wrong, conjugated, stride, most, options);
    if (steps.size() < options.motions.least) continue;
    with_like_lengths(steps);
    const Matrix3d R = orientation(steps, options.fit);
    for (const Matrix3d& W : nearest_orthogonal(linear_map(steps, R, options.fit))) {
      if (const std::optional<Matrix3d> permutation = nearest_permutation(W)) add(*permutation, conjugated);
      add(refined(steps, R, W, WrongAxes::of_one, options.fit.rounds), conjugated);
    }
  }
  // the position of the inverse pose beside the right rotation: inverse of what the inverse rotation gives
  PoseReading inverse_position;
  inverse_position.invert = inverse_position.conjugate = true;
  readings.push_back(inverse_position);
  return readings;
}

}  // namespace egocal::detail
