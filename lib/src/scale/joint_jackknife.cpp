// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "scale/joint_jackknife.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <vector>

#include "egocal/problem/cost.hpp"
#include "statistics/distributions.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Index of the tangents of planar mode among x y z roll pitch yaw.
constexpr std::array<Eigen::Index, 3> planar = {0, 1, 5};

/// J and its derivatives over u are v'(c0 t0 + c1 s t1 + c2 s^2 t2)v with t0 free of the scale, t1 linear and
/// t2 quadratic in it; the rotation rows are in t0 and c_rotation.
Matrix8d combined(const ScaleStatistics& part, double s, double rotation, double c0, double c1, double c2) {
  Matrix8d Q;
  Q.topLeftCorner<4, 4>() = c1 * s * part.cross + rotation * part.rotation;
  Q.topLeftCorner<4, 4>().diagonal().array() += c0 * part.square_b + c2 * s * s * part.square_a;
  Q.topRightCorner<4, 4>() = c0 * part.coupling_b + c1 * s * part.coupling_a;
  Q.bottomLeftCorner<4, 4>() = Q.topRightCorner<4, 4>().transpose();
  Q.bottomRightCorner<4, 4>() = c0 * part.rotation;
  return Q;
}

}  // namespace

JointDerivatives::OverScale JointDerivatives::over_scale() const {
  const Eigen::Index n = hessian.rows() - 1;
  const Eigen::LDLT<Hessian> extrinsic(hessian.topLeftCorner(n, n));
  OverScale result;
  if (extrinsic.info() != Eigen::Success || !extrinsic.isPositive()) return result;
  const Gradient mixed = hessian.col(n).head(n);
  const Gradient x = extrinsic.solve(mixed);
  const double curvature = 2 * (hessian(n, n) - mixed.dot(x));
  if (std::isfinite(curvature)) result.curvature = curvature;
  if (!x.allFinite()) return result;
  for (Eigen::Index i = 0; i < n; ++i)
    result.sensitivity[static_cast<std::size_t>(n == 3 ? planar[static_cast<std::size_t>(i)] : i)] = -x[i];
  return result;
}

JointForm::JointForm(const ScaleStatistics& all, const ScalePoint& point) : point_(point) {
  const Matrix86d basis = frame_a_basis(point.q);
  if (point.mode == Mode::spatial) {
    tangents_ = basis;
  } else {
    tangents_.resize(8, 3);
    for (Eigen::Index i = 0; i < 3; ++i) tangents_.col(i) = basis.col(planar[static_cast<std::size_t>(i)]);
  }
  const Matrix8d Q = cost_matrix(at_scale(all, point.scale), point.balance);
  const Multipliers lambda = least_squares_multipliers(Q, point.q);
  norm_ = lambda.norm / all.weight;
  orthogonal_ = lambda.orthogonal / all.weight;
}

JointDerivatives JointForm::of(const ScaleStatistics& part) const {
  const double s = point_.scale, k = point_.weight_slope;
  const double rotation = point_.balance.rotation / point_.weight;
  const double moved = point_.balance.translation / point_.weight;
  const Matrix8d Q = combined(part, s, rotation, moved, moved, moved);
  const Matrix8d dQ = combined(part, s, 0, moved * k, moved * (k + 1), moved * (k + 2));
  const Matrix8d ddQ =
      combined(part, s, 0, moved * k * k, moved * (k + 1) * (k + 1), moved * (k + 2) * (k + 2));
  const Vector8d v = point_.q.vec();
  const Vector8d slope = dQ * v;
  const Matrix8d Z = lagrangian_matrix(Q, {norm_ * part.weight, orthogonal_ * part.weight});
  const Eigen::Index n = tangents_.cols();
  JointDerivatives result;
  result.gradient.resize(n + 1);
  result.gradient.head(n) = tangents_.transpose() * (Q * v);
  result.gradient[n] = 0.5 * v.dot(slope);
  result.hessian.resize(n + 1, n + 1);
  result.hessian.topLeftCorner(n, n) = tangents_.transpose() * Z * tangents_;
  result.hessian.col(n).head(n) = tangents_.transpose() * slope;
  result.hessian.row(n).head(n) = result.hessian.col(n).head(n).transpose();
  result.hessian(n, n) = 0.5 * v.dot(ddQ * v);
  return result;
}

double spread_of_scale(std::span<const ScaleStatistics> blocks, const JointForm& form,
                       const JointDerivatives& all, std::size_t least_blocks) {
  if (blocks.size() < least_blocks) return infinity;
  std::uint64_t pairs = 0;
  for (const ScaleStatistics& block : blocks) pairs += block.count;
  std::vector<double> pseudo, weight;
  double mean = 0;
  for (const ScaleStatistics& block : blocks) {
    if (block.count == 0 || block.count == pairs) return infinity;
    const JointDerivatives left_out = form.of(block);
    const JointDerivatives::Hessian rest = all.hessian - left_out.hessian;
    const Eigen::LDLT<JointDerivatives::Hessian> factor(rest);
    if (factor.info() != Eigen::Success || !factor.isPositive()) return infinity;
    const JointDerivatives::Gradient step = -factor.solve(all.gradient - left_out.gradient);
    const double h = static_cast<double>(pairs) / static_cast<double>(block.count);
    pseudo.push_back(-(h - 1) * step[step.size() - 1]);
    weight.push_back(h);
    mean += pseudo.back() / h;
  }
  double variance = 0;
  for (std::size_t i = 0; i < pseudo.size(); ++i)
    variance += (pseudo[i] - mean) * (pseudo[i] - mean) / (weight[i] - 1);
  const double count = static_cast<double>(blocks.size());
  const double spread = student_factor(count - 1) * std::sqrt(variance / count);
  return std::isfinite(spread) ? spread : infinity;
}

}  // namespace egocal::detail
