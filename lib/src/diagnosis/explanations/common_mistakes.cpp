// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/common_mistakes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/explanations/lengths/scale.hpp"

namespace egocal::detail {

std::vector<Candidate> common_mistakes() {
  PoseReading as_read, inverted, wxyz, xyzw;
  inverted.invert = true;
  wxyz.quaternion_order = QuaternionOrder::wxyz;
  xyzw.quaternion_order = QuaternionOrder::xyzw;
  return {{"inverted_a", inverted, as_read},     {"inverted_b", as_read, inverted},
          {"inverted_both", inverted, inverted}, {"quaternion_order_a", wxyz, as_read},
          {"quaternion_order_a", xyzw, as_read}, {"quaternion_order_b", as_read, wxyz},
          {"quaternion_order_b", as_read, xyzw}, {"quaternion_order_both", wxyz, wxyz},
          {"quaternion_order_both", xyzw, xyzw}};
}

std::vector<Candidate> combined_mistakes() {
  PoseReading as_read, wxyz_inverted;
  wxyz_inverted.quaternion_order = QuaternionOrder::wxyz;
  wxyz_inverted.invert = true;
  return {{"quaternion_order_a", wxyz_inverted, as_read}, {"quaternion_order_b", as_read, wxyz_inverted}};
}

Explanation explained(const Evidence& evidence, int stride, const char* code, const PoseReading& a,
                      const PoseReading& b, const DiagnosisOptions& options) {
  Explanation result{code, a, b, evidence.clock, 1, {}};
  result.explained.motions =
      motions_of(evidence.instants, a, b, stride, options.motions.most, options.motions);
  if (!result.explained.motions.all.empty())
    result.explained.fit = robust_fit(result.explained.motions, options.fit);
  return result;
}

Explanation explained(const Evidence& evidence, const char* code, const PoseReading& a, const PoseReading& b,
                      const DiagnosisOptions& options) {
  return explained(evidence, evidence.stride, code, a, b, options);
}

Explanation with_scale(const Explanation& explanation, const DiagnosisOptions& options) {
  Explanation result = explanation;
  if (explanation.explained.motions.all.empty()) return result;
  ScaledFit scaled = fit_with_scale(explanation.explained.motions, options);
  result.scale = scaled.scale;
  result.explained = std::move(scaled.explained);
  return result;
}

bool explains(const Explained& explained, const DiagnosisOptions& options) {
  return explained.fit.typical < options.explains * options.explains;
}

bool better(const Comparison& comparison, double least_log_ratio, double sigmas) {
  return comparison.sigmas >= std::min(sigmas, 0.95 * comparison.most) && comparison.gain >= least_log_ratio;
}

bool better(const Comparison& comparison, double least_log_ratio, const DiagnosisOptions& options) {
  return better(comparison, least_log_ratio, options.sigmas);
}

bool number_explains(const Comparison& comparison, const DiagnosisOptions& options) {
  if (!better(comparison, options.least_gain, options)) return false;
  return comparison.sigmas >= options.sigmas || comparison.gain >= options.gain;
}

Finding finding_of(std::string code, const Explained& explained, const Comparison& comparison, bool certain) {
  Finding finding;
  finding.code = std::move(code);
  finding.certain = certain;
  finding.improvement = std::exp(comparison.gain);
  finding.T_a_b = to_pose(explained.fit.T);
  return finding;
}

Finding finding_of(const Explanation& explanation, const Comparison& comparison, bool certain) {
  return finding_of(explanation.code, explanation.explained, comparison, certain);
}

}  // namespace egocal::detail
