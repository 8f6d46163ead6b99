// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration/steps.hpp"

#include <utility>

#include "egocal/diagnosis/as_judged.hpp"
#include "egocal/scale/solve_scale.hpp"

namespace egocal::detail {

Calibration solved(Problem problem, Choice choice, const PairingCounts& counts, Method method) {
  Calibration result;
  result.choice = std::move(choice);
  result.counts = counts;
  const Answer answer = solve(problem, method);
  result.T_a_b = to_pose(answer.T_a_b);
  result.minimum = to_pose(answer.minimum);
  result.T_b_a = inverse(result.T_a_b);
  result.certificate = answer.certificate;
  result.observability = answer.observability;
  result.status = answer.status;
  result.problem = std::move(problem);
  return result;
}

Answered answered(const Calibration& calibration, Problem single, const std::optional<ScaleSolution>& scale) {
  Answered result;
  result.T_a_b = to_dual_quaternion(calibration.minimum);
  result.observability = calibration.observability;
  result.counts = calibration.counts;
  result.problem = std::move(single);
  result.stride = calibration.choice.stride;
  result.minimised = calibration.problem;
  if (scale) result.scale_stddev = spread_by_scale(calibration.observability, calibration.problem, *scale);
  return result;
}

Calibration judged(Calibration calibration, Diagnosis diagnosis) {
  calibration.verdict = diagnosis.verdict;
  calibration.observability = as_judged(std::move(calibration.observability), diagnosis);
  calibration.reason = std::move(diagnosis.reason);
  calibration.fit = std::move(diagnosis.fit);
  calibration.findings = std::move(diagnosis.findings);
  calibration.goal = std::move(diagnosis.goal);
  return calibration;
}

Diagnosis diagnose_without_poses(const Answered& answered, const DiagnosisOptions& options) {
  Diagnosis diagnosis = diagnose(answered, options);
  if (diagnosis.verdict != Verdict::good) return diagnosis;
  diagnosis.verdict = Verdict::incomplete;
  diagnosis.reason = "All directions are known; whether the motions agree was not looked at.";
  return diagnosis;
}

bool as_read(const Reading& reading) {
  return reading.quaternion_order == QuaternionOrder::as_read && !reading.invert && reading.scale == 1;
}

}  // namespace egocal::detail
