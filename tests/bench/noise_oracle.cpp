// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "noise_oracle.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace egocal::bench {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;  // rotation, then translation

Matrix6 adjoint(const Pose& p) {
  const Eigen::Matrix3d R = p.rotation.toRotationMatrix();
  const Eigen::Vector3d& t = p.translation;
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  Matrix6 Ad = Matrix6::Zero();
  Ad.topLeftCorner<3, 3>() = Ad.bottomRightCorner<3, 3>() = R;
  Ad.bottomLeftCorner<3, 3>() = cross * R;
  return Ad;
}

/// Of a stream whose frame has the axes of the plane, where there is one.
std::vector<Pose> motions_of(const Trajectory& trajectory, const Pose& T_sensor_axes) {
  std::vector<Pose> motions;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    motions.push_back(to_pose(to_dual_quaternion(inverse(T_sensor_axes)) * conjugate(trajectory[i - 1].pose) *
                              trajectory[i].pose * to_dual_quaternion(T_sensor_axes)));
  return motions;
}

/// Of the unknowns of a linear model r = J x + noise, whose covariance is a sum of parts of unknown size.
struct Fit {
  VectorXd x;
  MatrixXd covariance;
  double log_likelihood = -std::numeric_limits<double>::infinity();
};

Fit fit(const MatrixXd& J, const VectorXd& r, const std::vector<MatrixXd>& parts) {
  constexpr int rounds = 40;
  VectorXd size = VectorXd::Ones(static_cast<Eigen::Index>(parts.size()));
  Fit result;
  for (int round = 0; round <= rounds; ++round) {
    MatrixXd C = MatrixXd::Zero(r.size(), r.size());
    for (std::size_t i = 0; i < parts.size(); ++i) C += size[static_cast<Eigen::Index>(i)] * parts[i];
    const Eigen::LLT<MatrixXd> factor(C);
    const MatrixXd inverse = factor.solve(MatrixXd::Identity(r.size(), r.size()));
    const MatrixXd weighted = inverse * J;
    const MatrixXd information = J.transpose() * weighted;
    const Eigen::LDLT<MatrixXd> information_factor(information);
    result.x = information_factor.solve(weighted.transpose() * r);
    result.covariance = information_factor.solve(MatrixXd::Identity(J.cols(), J.cols()));
    const MatrixXd P = inverse - weighted * result.covariance * weighted.transpose();
    const VectorXd Pr = P * r;
    if (round == rounds) {
      const MatrixXd L = factor.matrixL();
      result.log_likelihood = -L.diagonal().array().log().sum() -
                              0.5 * information_factor.vectorD().array().abs().log().sum() - 0.5 * r.dot(Pr);
      break;
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const double quadratic = Pr.dot(parts[i] * Pr), expected = P.cwiseProduct(parts[i]).sum();
      size[static_cast<Eigen::Index>(i)] *= std::clamp(std::sqrt(quadratic / expected), 0.2, 5.0);
    }
    size = size.cwiseMax(1e-8);  // of the noise that was simulated
  }
  return result;
}

/// Correlation of the noise of two motions or poses.
MatrixXd in_time(Eigen::Index count, double memory) {
  MatrixXd R = MatrixXd::Identity(count, count);
  if (memory > 0)
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j)
        R(i, j) = std::exp(-static_cast<double>(std::abs(i - j)) / memory);
  return R;
}

struct Sensor {
  std::vector<Pose> motions;
  Matrix6 to_residual;
  double on_motions, on_poses;
};

/// Adds what unit noise of one sensor makes of the residuals.
void add_part(const Sensor& sensor, bool of_poses, bool of_rotations, double memory,
              const std::vector<int>& rows, MatrixXd& part) {
  const double level = of_poses ? sensor.on_poses : sensor.on_motions;
  if (!(level > 0)) return;
  const auto n = static_cast<Eigen::Index>(sensor.motions.size()), count = n + (of_poses ? 1 : 0);
  double mean = 0;
  for (const Pose& motion : sensor.motions)
    mean += (of_rotations ? rotation_log(motion.rotation).norm() : motion.translation.norm()) /
            static_cast<double>(n);
  const auto height = static_cast<Eigen::Index>(rows.size());
  MatrixXd G = MatrixXd::Zero(height * n, 3 * count);
  const auto set = [&](Eigen::Index i, Eigen::Index k, const Matrix6& M) {
    for (Eigen::Index row = 0; row < height; ++row)
      G.block<1, 3>(height * i + row, 3 * k) =
          level * mean * M.block<1, 3>(rows[static_cast<std::size_t>(row)], of_rotations ? 0 : 3);
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!of_poses) {
      set(i, i, sensor.to_residual);
      continue;
    }
    set(i, i + 1, sensor.to_residual);
    set(i, i, -sensor.to_residual * adjoint(inverse(sensor.motions[static_cast<std::size_t>(i)])));
  }
  const MatrixXd R = in_time(count, memory);
  MatrixXd all = MatrixXd::Zero(3 * count, 3 * count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) all.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(R(i, j));
  part += G * all * G.transpose();
}

}  // namespace

OracleAnswer oracle(const testing::Streams& streams, const DriveNoise& noise, bool plane) {
  Pose axes_a, axes_b;
  if (plane) {
    axes_a = to_pose(plane_frame(streams.options.plane_a));
    axes_b = to_pose(plane_frame(streams.options.plane_b));
    axes_a = inverse(Pose{axes_a.rotation, Eigen::Vector3d::Zero()});
    axes_b = inverse(Pose{axes_b.rotation, Eigen::Vector3d::Zero()});
  }
  const std::vector<Pose> a = motions_of(streams.a, axes_a), b = motions_of(streams.b, axes_b);
  const Pose T = to_pose(to_dual_quaternion(inverse(axes_a)) * streams.T * to_dual_quaternion(axes_b));
  std::vector<int> rows{0, 1, 2, 3, 4, 5};
  if (plane) rows = {2, 3, 4};
  const auto height = static_cast<Eigen::Index>(rows.size()), n = static_cast<Eigen::Index>(a.size());
  MatrixXd J(height * n, height);
  VectorXd r(height * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Pose rest = inverse(T) * inverse(a[k]) * T * b[k];
    Vector6 residual;
    residual << rotation_log(rest.rotation), rest.translation;
    const Matrix6 slope = adjoint(inverse(b[k])) - Matrix6::Identity();
    for (Eigen::Index row = 0; row < height; ++row) {
      const int from = rows[static_cast<std::size_t>(row)];
      r[height * i + row] = residual[from];
      for (Eigen::Index column = 0; column < height; ++column)
        J(height * i + row, column) = slope(from, rows[static_cast<std::size_t>(column)]);
    }
  }
  const Sensor sensors[] = {{a, adjoint(inverse(T)), noise.motions_a + noise.of_each, noise.poses_a},
                            {b, Matrix6::Identity(), noise.motions_b + noise.of_each, noise.poses_b}};
  const std::vector<double> memories =
      noise.memory > 0 ? std::vector<double>{0, 1, 2, 4, 8, 16, 32} : std::vector<double>{0};
  Fit best;
  for (const double memory : memories) {
    std::vector<MatrixXd> parts;
    for (const bool of_poses : {false, true})
      for (const bool of_rotations : {true, false}) {
        MatrixXd part = MatrixXd::Zero(r.size(), r.size());
        for (const Sensor& sensor : sensors) add_part(sensor, of_poses, of_rotations, memory, rows, part);
        if (part.trace() > 0) parts.push_back(std::move(part));
      }
    Fit here = fit(J, r, parts);
    if (here.log_likelihood > best.log_likelihood) best = std::move(here);
  }
  // r = J (x - what is sought): the fit of the residuals at the truth is the error
  OracleAnswer result;
  if (best.x.size() == 0) return result;
  Vector6 x = Vector6::Zero();
  Matrix6 covariance = Matrix6::Zero();
  for (Eigen::Index i = 0; i < height; ++i) {
    x[rows[static_cast<std::size_t>(i)]] = best.x[i];
    for (Eigen::Index j = 0; j < height; ++j)
      covariance(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(j)]) =
          best.covariance(i, j);
  }
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = T.rotation.toRotationMatrix();
  x = turn * x;
  covariance = turn * covariance * turn.transpose();
  for (int i = 0; i < 6; ++i) {
    const int from = (i + 3) % 6;  // x, y, z first
    const auto k = static_cast<std::size_t>(i);
    result.known[k] = covariance(from, from) > 0;
    result.error[k] = x[from];
    result.stddev[k] = std::sqrt(covariance(from, from));
  }
  return result;
}

}  // namespace egocal::bench
