// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "scale/joint_jackknife.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "egocal/problem/cost.hpp"
#include "statistics/distributions.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Index of the tangents of planar mode among x y z roll pitch yaw.
constexpr std::array<Eigen::Index, 3> planar = {0, 1, 5};

/// T'ZT of a symmetric Z.
template <int n>
Eigen::Matrix<double, n, n> restricted(const Matrix8d& Z, const Eigen::Matrix<double, 8, n>& tangents) {
  const Eigen::Matrix<double, 8, n> columns = Z.lazyProduct(tangents);
  return tangents.transpose().lazyProduct(columns);
}

/// Newton step of u without a part; empty where what is left has no minimum.
template <int n>
std::optional<double> step_without(const ScaleDerivatives& all, const ScaleDerivatives& part) {
  const Eigen::Matrix<double, n, n> hessian = all.hessian - part.hessian;
  const Eigen::LDLT<Eigen::Matrix<double, n, n>> factor(hessian);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return std::nullopt;
  const Eigen::Matrix<double, n, 1> step = factor.solve(all.gradient - part.gradient);
  return -step[n - 1];
}

}  // namespace

ScaleDerivatives::OverScale ScaleDerivatives::over_scale() const {
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

ScaleDerivatives JointForm::of(const ScaleStatistics& part) const {
  const double s = point_.scale, k = point_.weight_slope;
  const double moved = point_.balance.translation / point_.weight;
  const Eigen::Vector4d r = point_.q.real, d = point_.q.dual;
  const Matrix8d Q = part.weight / point_.weight * cost_matrix(at_scale(part, s), point_.balance);
  const Matrix8d Z = lagrangian_matrix(Q, {norm_ * part.weight, orthogonal_ * part.weight});
  // J / moved is v'(t0 + s t1 + s^2 t2)v, and e^(ku) J has the derivatives k, k + 1, k + 2 times these over
  // u: first t0 v, t1 v and t2 v
  Vector8d free, linear, square;
  free << part.square_b * r + part.coupling_b * d, part.coupling_b.transpose() * r + part.rotation * d;
  linear << s * (part.cross * r + part.coupling_a * d), s * (part.coupling_a.transpose() * r);
  square << s * s * part.square_a * r, Eigen::Vector4d::Zero();
  const Vector8d v = point_.q.vec();
  const Vector8d slope = moved * (k * free + (k + 1) * linear + (k + 2) * square);
  const double curvature =
      moved * (k * k * v.dot(free) + (k + 1) * (k + 1) * v.dot(linear) + (k + 2) * (k + 2) * v.dot(square));
  const Eigen::Index n = tangents_.cols();
  ScaleDerivatives result;
  result.gradient.resize(n + 1);
  result.gradient.head(n) = tangents_.transpose() * (Q * v);
  result.gradient[n] = 0.5 * v.dot(slope);
  result.hessian.resize(n + 1, n + 1);
  if (n == 6)
    result.hessian.topLeftCorner<6, 6>() = restricted<6>(Z, tangents_);
  else
    result.hessian.topLeftCorner<3, 3>() = restricted<3>(Z, tangents_);
  result.hessian.col(n).head(n) = tangents_.transpose() * slope;
  result.hessian.row(n).head(n) = result.hessian.col(n).head(n).transpose();
  result.hessian(n, n) = 0.5 * curvature;
  return result;
}

double spread_of_scale(std::span<const ScaleStatistics> blocks, const JointForm& form,
                       const ScaleDerivatives& all, std::size_t least_blocks) {
  if (blocks.size() < least_blocks) return infinity;
  std::uint64_t pairs = 0;
  for (const ScaleStatistics& block : blocks) pairs += block.count;
  std::vector<double> pseudo, weight;
  double mean = 0;
  for (const ScaleStatistics& block : blocks) {
    if (block.count == 0 || block.count == pairs) return infinity;
    const ScaleDerivatives left_out = form.of(block);
    const std::optional<double> step =
        all.gradient.size() == 7 ? step_without<7>(all, left_out) : step_without<4>(all, left_out);
    if (!step) return infinity;
    const double h = static_cast<double>(pairs) / static_cast<double>(block.count);
    pseudo.push_back(-(h - 1) * *step);
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
