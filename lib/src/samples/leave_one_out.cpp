// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/leave_one_out.hpp"

#include <cmath>
#include <limits>

#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

std::array<double, 6> spread_without_each(const SampleSet& set, const std::vector<std::size_t>& chosen,
                                          const SampleFit& fit) {
  std::array<double, 6> spread;
  spread.fill(std::numeric_limits<double>::infinity());
  // X and Y have twelve numbers, a sample six
  constexpr double samples_worth = 2;
  const auto n = static_cast<double>(chosen.size());
  if (chosen.size() < 4) return spread;
  FitSettings settings;
  settings.start = fit;
  settings.noise = fit.noise;
  std::vector<Vector6d> differences;
  Vector6d mean = Vector6d::Zero();
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    std::vector<std::size_t> rest = chosen;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
    differences.push_back(frame_a_difference(fit.X, fit_samples(set, rest, settings).X));
    mean += differences.back() / n;
  }
  // The jack-knife's (n - 1) / n counts one parameter a number; a difference is the residual over one minus
  // its leverage, which the parameters' share of the samples makes up for (Hinkley 1977).
  Vector6d squares = Vector6d::Zero();
  for (const Vector6d& difference : differences) squares += (difference - mean).cwiseAbs2();
  const double dof = n - samples_worth;
  const double student = 1 + 1.21 / dof;  // t(0.975) / 1.96, to a few hundredths from six degrees on
  for (int i = 0; i < 6; ++i) spread[static_cast<std::size_t>(i)] = student * std::sqrt(squares[i] * dof / n);
  return spread;
}

}  // namespace egocal::detail
