// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration/scale_verdict.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include "egocal/scale/solve_scale.hpp"

namespace egocal::detail {

namespace {

/// Whether the verdict's reason is a finding about the scale.
bool is_about_scale(const Calibration& calibration) {
  return std::any_of(calibration.findings.begin(), calibration.findings.end(), [&](const Finding& finding) {
    return (finding.code == "scale" || finding.code == "units") && finding.message == calibration.reason;
  });
}

/// Any finding about the scale follows from this one.
void put_end_of_range(const ScaleSolution& estimate, const CalibrationOptions& options, Calibration& result) {
  if (result.verdict > Verdict::incomplete && !is_about_scale(result)) return;
  const ScaleOptions searched = scale_options(options).scale;
  char text[192];
  std::snprintf(
      text, sizeof text,
      "The scale is not found: the best one is the end, %.4g, of the range that was searched, %g to "
      "%g. Multiply the lengths of %s by %.4g first.",
      estimate.scale, searched.least, searched.most, options.scale_side == Side::a ? "a" : "b",
      estimate.scale);
  result.verdict = std::max(result.verdict, Verdict::incomplete);
  result.reason = text;
}

}  // namespace

DriveScaleOptions scale_options(const CalibrationOptions& options) {
  DriveScaleOptions result;
  result.scale.side = options.scale_side;
  return result;
}

void put_scale(const std::optional<ScaleSolution>& estimate, double scale, const CalibrationOptions& options,
               Calibration& result) {
  result.scale = estimate;
  result.scale_applied = scale;
  if (estimate)
    result.observability = with_spread_of_scale(std::move(result.observability), result.problem, *estimate);
  if (estimate && estimate->at_limit) return put_end_of_range(*estimate, options, result);
  if (!estimate || result.verdict > Verdict::incomplete) return;
  const bool good = result.verdict == Verdict::good;
  if (!estimate->observable)
    result.reason = "The motions do not show the scale." + (good ? "" : " " + result.reason);
  else if (!estimate->certified && good)
    result.reason = "The scale is not proven to be the best one.";
  else
    return;
  result.verdict = Verdict::incomplete;
}

}  // namespace egocal::detail
