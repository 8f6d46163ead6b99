// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/leave_one_out.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "statistics/distributions.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// Differences of the answers without each sample from the one with all, in the frame of a.
std::vector<Vector6d> solved(const SampleSet& set, const std::vector<std::size_t>& chosen,
                             const SampleFit& fit) {
  FitSettings settings;
  settings.start = fit;
  settings.noise = fit.noise;
  std::vector<Vector6d> differences;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    std::vector<std::size_t> rest = chosen;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
    differences.push_back(frame_a_difference(fit.X, fit_samples(set, rest, settings).X));
  }
  return differences;
}

/// Sign of a sample's quaternion towards the answer.
double sign_of(const SampleSet& set, std::size_t i, const SampleFit& fit) {
  return fit.Y.real.dot(set.seen(i).real * fit.X.real) < 0 ? -1 : 1;
}

std::vector<Vector6d> stepped(const SampleSet& set, const std::vector<std::size_t>& chosen,
                              const SampleFit& fit) {
  // The cost is the sum of |(M - mean of the M) q|^2 over the samples, M = [dual real; real 0] in variances;
  // without one of n the part of this one goes, n / (n - 1) times.
  const auto n = static_cast<double>(chosen.size());
  const Pose Y = to_pose(fit.Y);
  QuaternionVector t;
  t << 0, Y.translation;
  const Eigen::Matrix4d half = 0.5 * left_matrix(t);
  SampleSums sums;
  for (const std::size_t i : chosen) sums.add(set.sums(i), sign_of(set, i, fit));
  const Eigen::Matrix4d mean_real = sums.real / n, mean_dual = (sums.dual - half * sums.real) / n;
  const double rotation = 1 / std::sqrt(fit.noise.rotation), position = 1 / std::sqrt(fit.noise.translation);
  const Matrix86d basis = frame_a_basis(fit.X);
  const Eigen::Matrix<double, 4, 6> basis_real = basis.topRows<4>(), basis_dual = basis.bottomRows<4>();

  struct Part {
    Matrix6d curvature;
    Vector6d gradient;
  };
  std::vector<Part> parts;
  parts.reserve(chosen.size());
  Matrix6d H = Matrix6d::Zero();
  for (const std::size_t i : chosen) {
    const SeenTarget& seen = set.seen(i);
    const double sign = sign_of(set, i, fit);
    const Eigen::Matrix4d real = sign * seen.real - mean_real,
                          dual = sign * (seen.dual - half * seen.real) - mean_dual;
    Matrix86d J;
    J.topRows<4>() = position * (dual.lazyProduct(basis_real) + real.lazyProduct(basis_dual));
    J.bottomRows<4>() = rotation * real.lazyProduct(basis_real);
    Vector8d r;
    r << position * (dual * fit.X.real + real * fit.X.dual), rotation * (real * fit.X.real);
    parts.push_back({J.transpose().lazyProduct(J), J.transpose() * r});
    H += parts.back().curvature;
  }
  constexpr double ridge = 1e-12;  // rounding: a direction that nothing shows is not reported
  H.diagonal() *= 1 + ridge;
  const double share = n / (n - 1);
  std::vector<Vector6d> differences;
  differences.reserve(parts.size());
  for (const Part& part : parts) {
    const Matrix6d rest = H - share * part.curvature;
    differences.push_back(rest.llt().solve(share * part.gradient));
  }
  return differences;
}

}  // namespace

std::array<double, 6> spread_without_each(const SampleSet& set, const std::vector<std::size_t>& chosen,
                                          const SampleFit& fit, std::size_t most_solved) {
  std::array<double, 6> spread;
  spread.fill(std::numeric_limits<double>::infinity());
  constexpr double samples_worth = 2;  // mathematics: X and Y have twelve numbers, a sample six
  const auto n = static_cast<double>(chosen.size());
  if (chosen.size() < 4) return spread;
  const std::vector<Vector6d> differences =
      chosen.size() <= most_solved ? solved(set, chosen, fit) : stepped(set, chosen, fit);
  Vector6d mean = Vector6d::Zero();
  for (const Vector6d& difference : differences) mean += difference / n;
  // The jack-knife's (n - 1) / n counts one parameter a number; a difference is the residual over one minus
  // its leverage, which the parameters' share of the samples makes up for (Hinkley 1977).
  Vector6d squares = Vector6d::Zero();
  for (const Vector6d& difference : differences) squares += (difference - mean).cwiseAbs2();
  const double dof = n - samples_worth;
  const double student = student_factor(dof);
  for (int i = 0; i < 6; ++i) spread[static_cast<std::size_t>(i)] = student * std::sqrt(squares[i] * dof / n);
  return spread;
}

}  // namespace egocal::detail
