// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/extrinsics/named_extrinsic.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "answers/answers.hpp"
#include "offline/common/backing_of.hpp"

namespace egocal::tools {

NamedExtrinsic named_extrinsic(std::string parent, std::string child, const Calibration& calibration) {
  NamedExtrinsic extrinsic;
  extrinsic.parent = std::move(parent);
  extrinsic.child = std::move(child);
  extrinsic.T_parent_child = calibration.T_a_b;
  extrinsic.certified = calibration.certificate.optimality == Optimality::certified;
  extrinsic.pairs = static_cast<long long>(sum_blocks(calibration.problem.blocks).count);
  extrinsic.stddev = calibration.observability.stddev;
  for (std::size_t i = 0; i < 6; ++i)
    if (!calibration.observability.observable[i])
      (*extrinsic.stddev)[i] = std::numeric_limits<double>::infinity();
  extrinsic.backing = backing_of(calibration);
  extrinsic.usable = calibration.verdict != Verdict::contradictory;
  extrinsic.verdict = to_string(calibration.verdict);
  extrinsic.reason = calibration.reason;
  return extrinsic;
}

std::vector<std::string> remarks(const NamedExtrinsic& extrinsic, const Calibration& calibration) {
  std::vector<std::string> lines;
  Diagnosis diagnosis;
  diagnosis.verdict = calibration.verdict;
  diagnosis.reason = calibration.reason;
  diagnosis.findings = calibration.findings;
  diagnosis.goal = calibration.goal;
  if (diagnosis.verdict != Verdict::good || unusable(diagnosis))
    lines.push_back(verdict_line(diagnosis) +
                    (diagnosis.verdict == Verdict::contradictory ? " Do not use this extrinsic." : ""));
  if (std::string not_shown = not_shown_in_words(extrinsic); !not_shown.empty())
    lines.push_back(std::move(not_shown));
  if (extrinsic.scale)
    lines.push_back(
        fmt::format("the lengths of {}, multiplied by {:.6g}, are those of {}{}{}{}", extrinsic.scale->sensor,
                    extrinsic.scale->value,
                    extrinsic.scale->sensor == extrinsic.parent ? extrinsic.child : extrinsic.parent,
                    extrinsic.scale->metres ? "" : ", and the translation is in their unit",
                    extrinsic.scale->certified ? "" : "; this scale is not certified",
                    std::isfinite(extrinsic.scale->stddev) ? "" : "; it is NOT OBSERVABLE"));
  return lines;
}

}  // namespace egocal::tools
