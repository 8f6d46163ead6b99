// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/leave_one_out.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "statistics/distributions.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

using Unit = std::vector<std::size_t>;

/// The chosen samples by their units, in the order of the first of each.
std::vector<Unit> units_of_chosen(const SampleSet& set, const std::vector<std::size_t>& chosen) {
  std::vector<Unit> units;
  std::vector<std::size_t> place(set.size(), set.size());
  for (const std::size_t i : chosen) {
    std::size_t& at = place[set.unit(i)];
    if (at == set.size()) {
      at = units.size();
      units.emplace_back();
    }
    units[at].push_back(i);
  }
  return units;
}

/// Divides the units into this many groups, each of units far apart in the order.
std::vector<Unit> groups_of(const std::vector<Unit>& units, std::size_t number) {
  constexpr std::size_t least = 8;  // fewer differences show no spread
  std::vector<Unit> groups(std::min(std::max(number, least), units.size()));
  for (std::size_t k = 0; k < units.size(); ++k) {
    Unit& group = groups[k % groups.size()];
    group.insert(group.end(), units[k].begin(), units[k].end());
  }
  for (Unit& group : groups) std::sort(group.begin(), group.end());
  return groups;
}

/// Differences of the answers without each unit from the one with all, in the frame of a.
std::vector<Vector6d> solved(const SampleSet& set, const std::vector<std::size_t>& chosen,
                             const std::vector<Unit>& units, const SampleFit& fit, FitPrecision precision) {
  FitSettings settings;
  settings.start = fit;
  settings.precision = precision;
  settings.noise = fit.noise;
  std::vector<Vector6d> differences;
  for (const Unit& unit : units) {
    std::vector<std::size_t> rest;
    std::set_difference(chosen.begin(), chosen.end(), unit.begin(), unit.end(), std::back_inserter(rest));
    differences.push_back(frame_a_difference(fit.X, fit_samples(set, rest, settings).X));
  }
  return differences;
}

/// Sign of a sample's quaternion towards the answer.
double sign_of(const SampleSet& set, std::size_t i, const SampleFit& fit) {
  return fit.Y.real.dot(set.seen(i).real * fit.X.real) < 0 ? -1 : 1;
}

std::vector<Vector6d> stepped(const SampleSet& set, const std::vector<std::size_t>& chosen,
                              const std::vector<Unit>& units, const SampleFit& fit) {
  // The cost is the sum of |(M - mean of the M) q|^2 over the samples, M = [dual real; real 0] in variances;
  // without m of n the part of these goes, that of their mean n / (n - m) times.
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
  struct Linear {
    Matrix86d J;
    Vector8d r;
  };
  const auto linear = [&](std::size_t i) {
    const SeenTarget& seen = set.seen(i);
    const double sign = sign_of(set, i, fit);
    const Eigen::Matrix4d real = sign * seen.real - mean_real,
                          dual = sign * (seen.dual - half * seen.real) - mean_dual;
    Linear one;
    one.J.topRows<4>() = position * (dual.lazyProduct(basis_real) + real.lazyProduct(basis_dual));
    one.J.bottomRows<4>() = rotation * real.lazyProduct(basis_real);
    one.r << position * (dual * fit.X.real + real * fit.X.dual), rotation * (real * fit.X.real);
    return one;
  };

  struct Part {
    Matrix6d curvature;
    Vector6d gradient;
  };
  std::vector<Part> parts;  // what goes with each unit
  parts.reserve(units.size());
  Matrix6d H = Matrix6d::Zero();
  for (const Unit& unit : units) {
    if (unit.size() == 1) {
      const Linear one = linear(unit[0]);
      const double share = n / (n - 1);
      const Matrix6d curvature = one.J.transpose().lazyProduct(one.J);
      const Vector6d gradient = one.J.transpose() * one.r;
      parts.push_back({share * curvature, share * gradient});
      H += curvature;
      continue;
    }
    const auto m = static_cast<double>(unit.size());
    std::vector<Linear> members;
    Linear mean{Matrix86d::Zero(), Vector8d::Zero()};
    for (const std::size_t i : unit) {
      members.push_back(linear(i));
      mean.J += members.back().J / m;
      mean.r += members.back().r / m;
    }
    Part about_mean{Matrix6d::Zero(), Vector6d::Zero()};
    for (const Linear& one : members) {
      about_mean.curvature += (one.J - mean.J).transpose().lazyProduct(one.J - mean.J);
      about_mean.gradient += (one.J - mean.J).transpose() * (one.r - mean.r);
    }
    const Part of_mean{mean.J.transpose().lazyProduct(mean.J), mean.J.transpose() * mean.r};
    const double share = m * n / (n - m);
    parts.push_back(
        {share * of_mean.curvature + about_mean.curvature, share * of_mean.gradient + about_mean.gradient});
    H += m * of_mean.curvature + about_mean.curvature;
  }
  constexpr double ridge = 1e-12;  // rounding: a direction that nothing shows is not reported
  H.diagonal() *= 1 + ridge;
  std::vector<Vector6d> differences;
  differences.reserve(parts.size());
  for (const Part& part : parts) {
    const Matrix6d rest = H - part.curvature;
    differences.push_back(rest.llt().solve(part.gradient));
  }
  return differences;
}

/// What the answer may be off along hidden directions, in the directions that these lean into a little.
Vector6d leaked_variance(const DirectionBasis& hidden, const DualQuaternion& X) {
  // a turn about a hidden axis may have any angle; a translation is as little known as what is claimed of it
  constexpr double any_angle = std::numbers::pi / std::numbers::sqrt3;  // mathematics: uniform, +-pi [rad]
  Vector6d variance = Vector6d::Zero();
  const Eigen::Vector3d t = to_pose(X).translation;
  for (Eigen::Index k = 0; k < hidden.basis.cols(); ++k) {
    const Eigen::Vector3d shift = hidden.basis.col(k).head<3>(), turn = hidden.basis.col(k).tail<3>();
    const double claimed = std::hypot(hidden.length, shift.dot(t));
    variance.head<3>() += claimed * claimed * shift.cwiseAbs2();
    variance.tail<3>() += any_angle * any_angle * turn.cwiseAbs2();
  }
  return variance;
}

}  // namespace

std::array<double, 6> spread_without_each(const SampleSet& set, const std::vector<std::size_t>& chosen,
                                          const SampleFit& fit, const DirectionBasis& hidden,
                                          std::size_t most_solved) {
  std::array<double, 6> spread;
  spread.fill(std::numeric_limits<double>::infinity());
  constexpr double samples_worth = 2;  // mathematics: X and Y have twelve numbers, a sample six
  std::vector<Unit> units = units_of_chosen(set, chosen);
  if (units.size() < 4) return spread;
  // Along a hidden direction the curvature is that of noise, which goes with the units: one Newton step says
  // next to nothing of how far the answer swings.
  const bool in_groups = hidden.basis.cols() > 0 && units.size() > most_solved;
  if (in_groups) units = groups_of(units, most_solved);
  const auto n = static_cast<double>(units.size());
  const std::vector<Vector6d> differences =
      in_groups || units.size() <= most_solved
          ? solved(set, chosen, units, fit, in_groups ? FitPrecision::on_the_way : FitPrecision::exact)
          : stepped(set, chosen, units, fit);
  Vector6d mean = Vector6d::Zero();
  for (const Vector6d& difference : differences) mean += difference / n;
  // The jack-knife's (n - 1) / n counts one parameter a number; a difference is the residual over one minus
  // its leverage, which the parameters' share of the samples makes up for (Hinkley 1977).
  Vector6d squares = Vector6d::Zero();
  for (const Vector6d& difference : differences) squares += (difference - mean).cwiseAbs2();
  const double dof = n - samples_worth;
  const double student = student_factor(dof);
  const Vector6d leaked = leaked_variance(hidden, fit.X);
  for (int i = 0; i < 6; ++i)
    spread[static_cast<std::size_t>(i)] = student * std::sqrt(squares[i] * dof / n + leaked[i]);
  return spread;
}

}  // namespace egocal::detail
