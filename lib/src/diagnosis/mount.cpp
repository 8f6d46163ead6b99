// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/wording.hpp"
#include "egocal/problem/constraints.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// Times that are tried, and the least part of the drive on either side.
constexpr int tries = 16, least_side = 2;
/// Blocks on either side whose scatter the change is compared with.
constexpr std::size_t blocks = 16;
/// Least F of the change against the scatter: F(6, 15) exceeds 10 once in 10,000 times; a few more for the
/// times that are tried.
constexpr double least_F = 14;
/// Below this part of the tolerance a change is not told from the odometries' own systematic errors, which
/// change along a drive.
constexpr double least_part = 0.25;

Motions part(const Motions& motions, std::size_t first, std::size_t last) {
  Motions result = motions;
  result.all.assign(motions.all.begin() + static_cast<std::ptrdiff_t>(first),
                    motions.all.begin() + static_cast<std::ptrdiff_t>(last));
  return result;
}

double sum_of_logs(const RobustFit& fit, double floor) {
  double sum = 0;
  for (const double square : fit.squares) sum += std::log(square + floor);
  return sum;
}

/// One side of the change: information and scatter of the gradients of its blocks.
struct Side {
  Matrix6d information = Matrix6d::Zero(), scatter = Matrix6d::Zero();
};

Side side_of(const Motions& motions, const RobustFit& fit, double length) {
  Side side;
  const DualQuaternion q = fit.T;
  Matrix86d tangent = frame_a_basis(q);
  tangent.leftCols<3>() *= length;
  const double w_r = motions.rotation > 0 ? 4 / (motions.rotation * motions.rotation) : 0;
  const double w_t = motions.translation > 0 ? 4 / (motions.translation * motions.translation) : 0;
  const std::size_t n = motions.all.size();
  const Vector8d v = q.vec();
  for (std::size_t block = 0; block < blocks; ++block) {
    Statistics statistics;
    for (std::size_t i = block * n / blocks; i < (block + 1) * n / blocks; ++i)
      statistics.add(motions.all[i].a, motions.all[i].b, fit.weights[i]);
    const Matrix8d Q = statistics.weight * cost_matrix(statistics, {w_r, w_t});
    const Matrix8d Z = lagrangian_matrix(Q, least_squares_multipliers(Q, q));
    const Vector6d slope = tangent.transpose() * (Z * v);
    side.information += tangent.transpose() * Q * tangent;
    side.scatter += slope * slope.transpose();
  }
  return side;
}

/// F statistic of the difference of the two answers.
double change_F(const Side& x, const Side& y, const Vector6d& change) {
  const auto inverse = [](const Matrix6d& H) -> Matrix6d {
    const double ridge = 1e-9 * H.diagonal().sum();
    return (H + ridge * Matrix6d::Identity()).llt().solve(Matrix6d::Identity());
  };
  const Matrix6d H_x = inverse(x.information), H_y = inverse(y.information);
  const double nu = 2.0 * static_cast<double>(blocks) - 12;
  Matrix6d V = H_x * x.scatter * H_x + H_y * y.scatter * H_y;
  V *= 2.0 * static_cast<double>(blocks) / nu;
  V += 1e-12 * V.trace() * Matrix6d::Identity();
  const double T2 = change.dot(V.ldlt().solve(change));
  return T2 * (nu - 5) / (6 * nu);
}

}  // namespace

std::optional<Finding> moved_mount(const Explained& whole, const DiagnosisOptions& options) {
  const std::size_t n = whole.motions.all.size();
  if (n < 8 * blocks || whole.motions.blocks < 16) return std::nullopt;
  const double floor = 0.25 * whole.fit.typical;
  std::size_t split = 0;
  double least = sum_of_logs(whole.fit, floor);
  for (int i = least_side; i <= tries - least_side; ++i) {
    const std::size_t here = static_cast<std::size_t>(i) * n / tries;
    const double sum = sum_of_logs(quick_fit(part(whole.motions, 0, here)), floor) +
                       sum_of_logs(quick_fit(part(whole.motions, here, n)), floor);
    if (sum < least) {
      least = sum;
      split = here;
    }
  }
  if (split == 0) return std::nullopt;
  const Motions before = part(whole.motions, 0, split), after = part(whole.motions, split, n);
  const RobustFit fit_before = robust_fit(before), fit_after = robust_fit(after);
  Explained two{whole.motions, fit_before};
  two.fit.squares.insert(two.fit.squares.end(), fit_after.squares.begin(), fit_after.squares.end());
  const Comparison comparison = compare(whole, two);
  if (comparison.sigmas < std::min(options.sigmas, 0.95 * comparison.most)) return std::nullopt;

  Vector6d change = frame_a_difference(fit_before.T, fit_after.T);
  const double rotation = change.tail<3>().norm(), translation = change.head<3>().norm();
  if (rotation < least_part * options.tolerance_rotation &&
      translation < least_part * options.tolerance_translation)
    return std::nullopt;
  const double length =
      whole.motions.rotation > 0 ? std::max(1e-6, whole.motions.translation / whole.motions.rotation) : 1;
  change.head<3>() /= length;
  const double F = change_F(side_of(before, fit_before, length), side_of(after, fit_after, length), change);
  if (!(F > least_F)) return std::nullopt;

  Finding finding;
  finding.code = "mount_moved";
  finding.certain = true;
  finding.improvement = std::exp(comparison.gain);
  finding.time = 0.5 * (before.all.back().time + after.all.front().time);
  finding.T_a_b = to_pose(fit_after.T);
  finding.message = format("The mounting changed by %.2f deg and %.1f cm about %.1f s after the start.",
                           rotation * 180 / std::numbers::pi, 100 * translation, *finding.time);
  finding.remedy = format("Calibrate the drive before and after %.1f s separately.", *finding.time);
  return finding;
}

}  // namespace egocal::detail
