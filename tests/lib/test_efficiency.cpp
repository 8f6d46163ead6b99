// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How close the chosen stride and weights come to what no estimator can pass: maximum likelihood, with the
// noise known exactly and the search begun at the truth.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdio>
#include <numbers>

#include "../support/simulated_drive.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"

namespace egocal::test_efficiency {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;  // rotation [rad], then translation [m]
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double relative_noise = 0.01;
constexpr int drives = 20;
const Pose T_a_b = inverse(testing::T_vehicle_a) * testing::T_vehicle_b;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// p exp(xi) = exp(Ad xi) p
Matrix6 adjoint(const Pose& p) {
  const Eigen::Matrix3d R = p.rotation.toRotationMatrix();
  Matrix6 Ad = Matrix6::Zero();
  Ad.topLeftCorner<3, 3>() = R;
  Ad.bottomRightCorner<3, 3>() = R;
  Ad.bottomLeftCorner<3, 3>() = cross_matrix(p.translation) * R;
  return Ad;
}

testing::Streams drive_of(Terrain terrain, int poses, std::uint64_t seed, double noise) {
  return testing::simulated_drive(
      {.terrain = terrain, .poses = poses, .relative_noise = noise, .seed = seed});
}

std::vector<Pose> motions_of(const Trajectory& trajectory) {
  std::vector<Pose> motions;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    motions.push_back(inverse(to_pose(trajectory[i - 1].pose)) * to_pose(trajectory[i].pose));
  return motions;
}

/// Of the noise of one motion, as simulation.hpp defines it: from the mean rotation and translation.
Matrix6 noise_covariance(const std::vector<Pose>& clean) {
  double rotation = 0, translation = 0;
  for (const Pose& motion : clean) {
    rotation += rotation_log(motion.rotation).norm();
    translation += motion.translation.norm();
  }
  const double scale = relative_noise / static_cast<double>(clean.size());
  Vector6 variance;
  variance.head<3>().setConstant(std::pow(scale * rotation, 2));
  variance.tail<3>().setConstant(std::pow(scale * translation, 2));
  return variance.asDiagonal();
}

/// Gauss-Newton on inverse(T) inverse(m_a) T m_b, which is the noise of b less that of a seen from b.
Pose maximum_likelihood(const std::vector<Pose>& a, const std::vector<Pose>& b, const Matrix6& information) {
  Pose T = T_a_b;
  for (int iteration = 0; iteration < 10; ++iteration) {
    Matrix6 H = Matrix6::Zero();
    Vector6 gradient = Vector6::Zero();
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Pose rest = inverse(T) * inverse(a[i]) * T * b[i];
      Vector6 residual;
      residual << rotation_log(rest.rotation), rest.translation;
      const Matrix6 J = adjoint(inverse(b[i])) - Matrix6::Identity();
      H += J.transpose() * information * J;
      gradient += J.transpose() * information * residual;
    }
    const Vector6 step = -H.ldlt().solve(gradient);
    T = T * Pose{rotation_exp(step.head<3>()), step.tail<3>()};
  }
  return T;
}

struct Medians {
  double best, ours;  ///< rotation error [rad]
};

Medians medians(Terrain terrain, int poses, std::uint64_t first_seed) {
  std::vector<double> best, ours;
  const DualQuaternion truth = to_dual_quaternion(T_a_b);
  for (std::uint64_t seed = first_seed; seed < first_seed + drives; ++seed) {
    const testing::Streams clean = drive_of(terrain, poses, seed, 0);
    const testing::Streams noisy = drive_of(terrain, poses, seed, relative_noise);
    const Matrix6 Ad = adjoint(inverse(T_a_b));
    const Matrix6 covariance =
        noise_covariance(motions_of(clean.b)) + Ad * noise_covariance(motions_of(clean.a)) * Ad.transpose();
    const Pose T = maximum_likelihood(motions_of(noisy.a), motions_of(noisy.b), covariance.inverse());
    best.push_back(extrinsic_error(truth, to_dual_quaternion(T)).rotation);
    const MotionPairing drive = pair_motions({}, noisy.a, noisy.b).drive;
    ours.push_back(extrinsic_error(truth, solve(drive.problem(), Method::dual).T_a_b).rotation);
  }
  const auto median = [](std::vector<double> errors) {
    std::sort(errors.begin(), errors.end());
    return (errors[drives / 2 - 1] + errors[drives / 2]) / 2;
  };
  constexpr double degrees = 180 / std::numbers::pi;
  std::printf("seeds from %d: ours %.4f deg, maximum likelihood %.4f deg\n", static_cast<int>(first_seed),
              degrees * median(ours), degrees * median(best));
  return {median(best), median(ours)};
}

TEST(Efficiency, OnARoadAsGoodAsKnowingTheNoise) {
  for (const std::uint64_t seed : {1u, 101u}) {
    const Medians m = medians(Terrain::rough, 1001, seed);
    EXPECT_LT(m.ours, 1.1 * m.best);
  }
}

TEST(Efficiency, InSixDegreesOfFreedomNearlyAsGoodAsKnowingTheNoise) {
  for (const std::uint64_t seed : {1u, 101u}) {
    const Medians m = medians(Terrain::free, 201, seed);
    EXPECT_LT(m.ours, 1.1 * m.best);
  }
}

}  // namespace
}  // namespace egocal::test_efficiency
