// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/turning/rates_in_degrees.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "linear_algebra/screw_matrix.hpp"

namespace egocal::detail {

namespace {

/// How far a stream turns from row to row, a second [rad/s].
double turning_rate(const Trajectory& rows) {
  if (rows.size() < 2) return 0;
  double sum = 0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    sum += rotation_angle(quaternion_product(quaternion_conjugate(rows[i - 1].pose.real), rows[i].pose.real));
  return sum / to_seconds(rows.back().time_us - rows.front().time_us);
}

/// The same twists, whose turning was in degrees.
Trajectory in_radians(const Trajectory& rows) {
  Trajectory result = rows;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Pose step = to_pose(conjugate(rows[i - 1].pose) * rows[i].pose);
    const Eigen::Vector3d turn = rotation_log(step.rotation), right = radians_per_degree * turn;
    const Eigen::Vector3d way = screw_matrix(turn).inverse() * step.translation;
    result[i].pose = canonical_sign(normalized(
        result[i - 1].pose * to_dual_quaternion({rotation_exp(right), screw_matrix(right) * way})));
  }
  return result;
}

}  // namespace

std::optional<Finding> rates_in_degrees(const Evidence& evidence, const DiagnosisOptions& options,
                                        const RatesInDegreesOptions& rates) {
  const Trajectory &a = evidence.streams.a, &b = evidence.streams.b;
  const double rate_a = turning_rate(a), rate_b = turning_rate(b);
  const bool of_b = rate_b > rates.least_ratio * rate_a;
  if (!of_b && !(rate_a > rates.least_ratio * rate_b)) return std::nullopt;
  const Trajectory right = in_radians(of_b ? b : a);
  const Instants instants = synchronised(of_b ? a : right, of_b ? right : b, evidence.clock,
                                         evidence.streams.max_gap, 1, options.motions);
  const int stride = std::max(1, static_cast<int>(instants.size()) / rates.motions);
  Explained here{motions_of(instants, {}, {}, stride, options.motions.most, options.motions), {}};
  const Explanation given = explained(evidence, stride, "", {}, {}, options);
  if (here.motions.all.size() < options.motions.least || given.explained.motions.all.empty())
    return std::nullopt;
  here.fit = robust_fit(here.motions, options.fit);
  const Comparison comparison = compare(given.explained, here);
  if (!explains(here, options) || !better(comparison, rates.gain, options)) return std::nullopt;
  const char* const stream = mark(of_b ? 'b' : 'a');
  Finding finding = finding_of(of_b ? "turning_scale_b" : "turning_scale_a", here, comparison, true);
  finding.value = 1 / radians_per_degree;
  say(finding, format("The turning rates of %s are in degrees a second", stream),
      format("Give the turning rates of %s in radians a second.", stream),
      format(": the squared residuals are %.3g times smaller with %s turning by a 57.3th of what it does.",
             finding.improvement, stream));
  return finding;
}

}  // namespace egocal::detail
