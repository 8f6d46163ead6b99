// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration/inverted_streams.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "diagnosis/explanations/both_streams.hpp"
#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/motions/motions.hpp"

namespace egocal::detail {

void doubt_inversion_of_both(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options,
                             Calibration& calibration) {
  if (!options.diagnosis.enabled || calibration.verdict == Verdict::contradictory) return;
  const auto of_both = [](const Finding& one) { return one.code == "inverted_both"; };
  const auto known = std::find_if(calibration.findings.begin(), calibration.findings.end(), of_both);
  if (known != calibration.findings.end() && known->certain) return;
  ClockModel clock;
  clock.offset = calibration.time_offset_applied;
  std::optional<Finding> in_vain =
      inverted_in_vain(gather(a, b, clock, options.pairing.max_gap, options.diagnosis), options.diagnosis);
  if (!in_vain) return;
  std::erase_if(calibration.findings, of_both);
  if (calibration.verdict < Verdict::doubtful) {
    calibration.verdict = Verdict::doubtful;
    calibration.reason = in_vain->message;
  }
  calibration.findings.insert(calibration.findings.begin(), *std::move(in_vain));
}

}  // namespace egocal::detail
