// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/half_turns.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace egocal::detail {

namespace {

QuaternionVector turn_between(const DualQuaternion& from, const DualQuaternion& to) {
  return quaternion_product(quaternion_conjugate(from.real), to.real);
}

/// Axes of the motions of b that are nearly half turns, in sensor b's frame.
std::vector<Eigen::Vector3d> half_turn_axes(const SampleSet& set, std::span<const std::size_t> chosen,
                                            const HalfTurnOptions& options) {
  constexpr std::size_t all = 3;  // mathematics: half turns that commute have at most three axes
  std::vector<Eigen::Vector3d> axes;
  const DualQuaternion& first = set.sample(chosen.front()).b;
  for (const std::size_t i : chosen) {
    const QuaternionVector turn = turn_between(first, set.sample(i).b);
    if (std::abs(turn[0]) > options.nearly) continue;
    const Eigen::Vector3d axis = turn.tail<3>().normalized();
    const bool known = std::any_of(axes.begin(), axes.end(), [&](const Eigen::Vector3d& other) {
      return std::abs(axis.dot(other)) > options.least_apart;
    });
    if (!known) axes.push_back(axis);
    if (axes.size() == all) break;
  }
  // one half turn after another is one about the third axis
  if (axes.size() == 2) axes.push_back(axes[0].cross(axes[1]).normalized());
  return axes;
}

/// `fit` with another X, and the target that the samples see with it.
SampleFit with_X(const SampleSet& set, std::span<const std::size_t> chosen, const SampleFit& fit,
                 const DualQuaternion& X) {
  SampleFit other = fit;
  other.X = X;
  other.Y = set.seen(chosen.front()).with(X);  // for the signs
  other.Y = target_at(set, chosen, other, X);
  return other;
}

double squared_rotations(const SampleSet& set, std::span<const std::size_t> chosen, const SampleFit& fit) {
  double sum = 0;
  for (const std::size_t i : chosen) sum += squared_residual(set, i, fit).rotation;
  return sum;
}

}  // namespace

std::vector<SampleFit> half_turned(const SampleSet& set, std::span<const std::size_t> chosen,
                                   const SampleFit& fit, const HalfTurnOptions& options) {
  std::vector<std::size_t> some;
  const std::size_t step = (chosen.size() + options.most_looked_at - 1) / options.most_looked_at;
  for (std::size_t k = 0; k < chosen.size(); k += step) some.push_back(chosen[k]);
  const double least = options.least_noise * options.least_noise * static_cast<double>(some.size());
  const double most = options.as_good * std::max(least, squared_rotations(set, some, fit));
  std::vector<SampleFit> others;
  for (const Eigen::Vector3d& axis : half_turn_axes(set, chosen, options)) {
    DualQuaternion half_turn;
    half_turn.real << 0, axis;
    half_turn.dual.setZero();
    SampleFit other = with_X(set, some, fit, fit.X * half_turn);
    if (squared_rotations(set, some, other) <= most) others.push_back(std::move(other));
  }
  return others;
}

SampleFit fit_of_few(const SampleSet& set, const FitSettings& settings, const HalfTurnOptions& options) {
  std::vector<std::size_t> all(set.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const SampleFit fit = fit_samples(set, all, settings);
  std::vector<double> signs;
  std::vector<std::size_t> open;
  const PoseSample& first = set.sample(0);
  for (const std::size_t i : all) {
    signs.push_back(set.sign(0, i));
    if (std::min(std::abs(turn_between(first.a, set.sample(i).a)[0]),
                 std::abs(turn_between(first.b, set.sample(i).b)[0])) < options.nearly)
      open.push_back(i);
  }
  SampleFit best = fit;
  for (std::size_t choice = 1; choice < std::size_t{1} << open.size(); ++choice) {
    FitSettings with_signs = settings;
    with_signs.signs = signs;
    for (std::size_t k = 0; k < open.size(); ++k)
      if (choice >> k & 1) with_signs.signs[open[k]] *= -1;
    SampleFit other = fit_samples(set, all, with_signs);
    if (clearly_better(other, best)) best = std::move(other);
  }
  return best;
}

}  // namespace egocal::detail
