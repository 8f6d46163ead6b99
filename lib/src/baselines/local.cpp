// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "baselines/usable.hpp"
#include "egocal/baselines/baselines.hpp"
#include "linear_algebra/cross_matrix.hpp"

namespace egocal {
namespace {

using detail::cross_matrix;

// Tangent vectors are (rotation vector [rad], translation [m]), the logarithm of a unit dual quaternion times
// two.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// exp of half the tangent, as dual numbers: with dual angle theta + eps s about the axis,
/// cos(theta/2) + axis sin(theta/2).
DualQuaternion exponential(const Vector6d& tangent) {
  const Eigen::Vector3d w = 0.5 * tangent.head<3>(), v = 0.5 * tangent.tail<3>();
  const double angle = w.norm();
  const double wv = w.dot(v);
  // sinc and (cos - sinc) / angle^2, by their series near zero
  const double sinc = angle < 1e-4 ? 1 - angle * angle / 6 : std::sin(angle) / angle;
  const double second =
      angle < 1e-4 ? -1.0 / 3 + angle * angle / 30 : (std::cos(angle) - sinc) / (angle * angle);
  DualQuaternion q;
  q.real << std::cos(angle), sinc * w;
  q.dual << -sinc * wv, sinc * v + second * wv * w;
  return normalized(q);
}

/// The tangent whose exponential is q, the shorter way round.
Vector6d logarithm(const DualQuaternion& q_any_sign) {
  const DualQuaternion q = canonical_sign(q_any_sign);
  const Eigen::Vector3d w = q.real.tail<3>(), v = q.dual.tail<3>();
  const double sine = w.norm(), cosine = q.real[0];
  const double angle = std::atan2(sine, cosine);
  // angle / sin and its derivative over sin, (cosine angle / sine - 1) / sine^2 up to the sign
  const double inverse_sinc = sine < 1e-4 ? 1 + sine * sine / 6 : angle / sine;
  const double second = sine < 1e-4 ? 1.0 / 3 : (1 - cosine * inverse_sinc) / (sine * sine);
  // dual angle: d(angle) = -dual scalar / sin; log = axis * angle with dual parts by the product rule
  Vector6d tangent;
  const double scalar_over_sine2 = -q.dual[0];  // = (angle's dual part) * sine
  tangent.head<3>() = 2 * inverse_sinc * w;
  tangent.tail<3>() = 2 * (inverse_sinc * v + second * scalar_over_sine2 * w);
  return tangent;
}

Matrix6d adjoint_small(const Vector6d& t) {
  Matrix6d ad = Matrix6d::Zero();
  ad.topLeftCorner<3, 3>() = ad.bottomRightCorner<3, 3>() = cross_matrix(t.head<3>());
  ad.bottomLeftCorner<3, 3>() = cross_matrix(t.tail<3>());
  return ad;
}

Matrix6d adjoint(const DualQuaternion& q) {
  const Pose T = to_pose(q);
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  Matrix6d Ad = Matrix6d::Zero();
  Ad.topLeftCorner<3, 3>() = Ad.bottomRightCorner<3, 3>() = R;
  Ad.bottomLeftCorner<3, 3>() = cross_matrix(T.translation) * R;
  return Ad;
}

struct Quadratic {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double cost = 0;
};

/// Sum of |log(A T B^-1 T^-1)|^2 and its Gauss-Newton model for T <- exp(xi) T.
double sum_of_squares(const std::vector<MotionPair>& pairs, const DualQuaternion& T, Quadratic* model) {
  const DualQuaternion T_inverse = conjugate(T);
  double sum = 0;
  for (const MotionPair& pair : pairs) {
    const Vector6d e = logarithm(pair.a * T * conjugate(pair.b) * T_inverse);
    sum += pair.eta * e.squaredNorm();
    if (!model) continue;
    // log(exp(Ad_A xi) E exp(-xi)) = e + J_l^-1 Ad_A xi - J_r^-1 xi, the inverse Jacobians by their Bernoulli
    // series
    const Matrix6d ad = adjoint_small(e);
    const Matrix6d even = Matrix6d::Identity() + ad * ad / 12;
    const Matrix6d J = (even - ad / 2) * adjoint(pair.a) - (even + ad / 2);
    model->H += pair.eta * J.transpose() * J;
    model->g += pair.eta * J.transpose() * e;
  }
  if (model) model->cost = sum;
  return sum;
}

}  // namespace

BaselineAnswer solve_local(std::span<const MotionPair> pairs, const DualQuaternion& start) {
  constexpr int max_iterations = 200;  // a limit: ten are the rule
  BaselineAnswer answer;
  const std::vector<MotionPair> usable = usable_pairs(pairs);
  if (usable.empty() || !start.vec().allFinite()) {
    answer.note = usable.empty() ? "no motion pairs" : "the start is not finite";
    return answer;
  }
  DualQuaternion T = normalized(start);
  double damping = 1e-3;
  bool converged = false;
  Quadratic model;
  double cost = sum_of_squares(usable, T, &model);
  for (int i = 0; i < max_iterations && !converged; ++i) {
    Matrix6d H = model.H;
    H.diagonal() += damping * model.H.diagonal() + Vector6d::Constant(1e-15 * model.H.trace());
    const Vector6d step = -H.ldlt().solve(model.g);
    if (!step.allFinite()) break;
    const DualQuaternion candidate = normalized(exponential(step) * T);
    const double candidate_cost = sum_of_squares(usable, candidate, nullptr);
    const bool tiny = step.norm() <= 1e-12;
    if (candidate_cost <= cost) {
      converged = tiny || cost - candidate_cost <= 1e-15 * cost;
      T = candidate;
      damping = std::max(1e-12, damping / 10);
      model = Quadratic{};
      cost = sum_of_squares(usable, T, &model);
    } else {
      converged = tiny;  // no descent left above rounding
      damping *= 10;
      if (damping > 1e15) break;
    }
  }
  answer.T_a_b = canonical_sign(T);
  answer.valid = converged;
  if (!converged) answer.note = "did not converge: a poor start, or directions that the motions do not show";
  return answer;
}

}  // namespace egocal
