// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The joint minimum is global: docs/rigs.md has the proof, in the notation of this file.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "rig/chart.hpp"
#include "rig/joint.hpp"
#include "rig/pair_form.hpp"
#include "rig/remainder.hpp"

namespace egocal::detail {

namespace {

using namespace joint;

/// Adds this pair's part of the gradient over the coordinates of `chart`, and what rounding may have done.
void add_gradient(const Form& form, const std::array<Vector8, 6>& directions, double sign,
                  std::array<double, 6>& gradient, double& error) {
  for (std::size_t k = 0; k < 6; ++k) {
    gradient[k] += sign * 2 * form.at(real_one, directions[k]);
    error += 2 * form.error_of(real_one, directions[k]);
  }
}

struct Charts {
  std::vector<std::optional<Chart>> of;  ///< empty for sensor 0
};

std::optional<Charts> charts_of(std::span<const JointPair> pairs, const std::vector<Form>& forms,
                                std::size_t sensors) {
  Charts charts{std::vector<std::optional<Chart>>(sensors)};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].a != 0 || charts.of[pairs[i].b]) continue;
    charts.of[pairs[i].b] = chart_of(forms[i]);
    if (!charts.of[pairs[i].b]) return std::nullopt;
  }
  for (std::size_t s = 1; s < sensors; ++s)
    if (!charts.of[s]) return std::nullopt;
  return charts;
}

/// |R| <= kappa |Y|^2 for all pairs together.
double curvature_of(std::span<const JointPair> pairs, const std::vector<Form>& forms, const Charts& charts,
                    double radius) {
  std::vector<double> squares(charts.of.size(), 0);
  double product = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Chart& b = *charts.of[pairs[i].b];
    if (pairs[i].a == 0) {
      squares[pairs[i].b] += std::pow(scalar_part(forms[i], b, least_scalar(b, radius)), 2);
      continue;
    }
    const Remainder part = remainder_of(forms[i], *charts.of[pairs[i].a], b, radius);
    squares[pairs[i].a] += part.square_a * part.square_a;
    squares[pairs[i].b] += part.square_b * part.square_b;
    product = std::max(product, part.product);
  }
  return upwards *
         (std::sqrt(0.5) * product + std::sqrt(2 * *std::max_element(squares.begin(), squares.end())));
}

/// The length of the gradient over all coordinates, at most.
double gradient_length(std::span<const JointPair> pairs, const std::vector<Form>& forms,
                       const Charts& charts) {
  std::vector<std::array<double, 6>> gradient(charts.of.size(), std::array<double, 6>{});
  double error = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    add_gradient(forms[i], charts.of[pairs[i].b]->C, 1, gradient[pairs[i].b], error);
    if (pairs[i].a == 0) continue;
    const Vector8& m = forms[i].m();
    const Vector8 back = {m[0], -m[1], -m[2], -m[3], m[4], -m[5], -m[6], -m[7]};
    std::array<Vector8, 6> seen;
    for (std::size_t k = 0; k < 6; ++k) seen[k] = product(back, product(charts.of[pairs[i].a]->C[k], m));
    add_gradient(forms[i], seen, -1, gradient[pairs[i].a], error);
  }
  double sum = 0;
  for (const auto& part : gradient)
    for (const double g : part) sum += g * g;
  return upwards * (std::sqrt(sum) + error);
}

}  // namespace

std::optional<JointProof> prove_joint_minimum(std::span<const JointPair> pairs,
                                              const std::vector<DualQuaternion>& poses) {
  JointProof proof;
  std::vector<Form> forms;
  double gap = 0, cost = 0;
  for (const JointPair& pair : pairs) {
    const Form& form = forms.emplace_back(pair, poses);
    if (!proven_bound<8>(pair.Q, form.bound(), form.multiplier(), 0)) return std::nullopt;
    const double excess = form.at_most(real_one);
    gap += excess;
    cost += form.bound() + excess;
    proof.pairwise_bound += form.bound();
    proof.rounding += 2 * form.error_of(real_one, real_one);
  }
  // sums of so few terms that their rounding is far below the margins in them
  gap *= upwards;
  proof.lower_bound = proof.pairwise_bound -= form_error * std::abs(proof.pairwise_bound);
  const double radius = std::sqrt(gap) * upwards;
  const std::optional<Charts> charts = charts_of(pairs, forms, poses.size());
  if (!charts) return proof;
  for (std::size_t s = 1; s < poses.size(); ++s)
    if (!(least_scalar(*charts->of[s], radius) > 0)) return proof;
  const double eta = curvature_of(pairs, forms, *charts, radius) * radius * upwards;
  const double convexity = (1 - eta) * (1 - eta) - 2 * eta * upwards;
  if (!(eta < 1) || !(convexity > 0)) return proof;
  const double gradient = gradient_length(pairs, forms, *charts);
  proof.global = true;
  // `cost` is at most its rounding above that of the poses; the rest is the least value of
  // convexity |X|^2 - |gradient| |X|
  const double bound = cost - proof.rounding - upwards * gradient * gradient / (4 * convexity);
  proof.lower_bound = std::max(proof.lower_bound, bound);
  return proof;
}

}  // namespace egocal::detail
