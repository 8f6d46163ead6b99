// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/pair/baseline_answer.hpp"

#include <chrono>

#include "egocal/baselines/baselines.hpp"
#include "egocal/certificate/certificate.hpp"
#include "offline/pair/solve_time.hpp"

namespace egocal::tools {

void answer_by_baseline(const std::string& method, const std::vector<MotionPair>& pairs,
                        SolveResult& result) {
  const auto run = [&] {
    if (method == "analytic") return solve_analytic(pairs);
    if (method == "matrix") return solve_matrix(pairs);
    return solve_local(pairs);
  };
  const BaselineAnswer baseline = run();
  const DualQuaternion q = canonical_sign(normalized(baseline.T_a_b));
  Calibration& calibration = result.calibration;
  calibration.T_a_b = to_pose(q);
  calibration.T_b_a = inverse(calibration.T_a_b);
  calibration.problem.prior.reset();  // the baselines know none
  calibration.certificate = verify(cost_matrix(calibration.problem), q);
  result.note = baseline.valid ? "" : baseline.note;
  result.solve_us = median_us([&] {
    const auto start = std::chrono::steady_clock::now();
    run();
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
  });
}

}  // namespace egocal::tools
