// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/named_extrinsic.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "answers/answers.hpp"
#include "egocal/uncertainty/observability.hpp"

namespace egocal::tools {

namespace {

/// Whether the ground planes give this direction, or a part of it.
bool of_planes(const Calibration& calibration, std::size_t direction) {
  const double normal = std::abs(calibration.problem.plane_a.normal[static_cast<int>(direction % 3)]);
  const double leak = ObservabilityOptions().leak;
  return direction < 3 ? normal > leak : 1 - normal > leak;
}

}  // namespace

std::array<Backing, 6> backing_of(const Calibration& calibration) {
  const bool planar = calibration.problem.mode == Mode::planar;
  std::array<Backing, 6> backing{};
  for (std::size_t i = 0; i < backing.size(); ++i) {
    if (calibration.observability.observable[i]) continue;
    if (planar)
      backing[i] = of_planes(calibration, i) ? Backing::planes : Backing::none;
    else
      backing[i] = calibration.problem.prior ? Backing::nominal : Backing::none;
  }
  return backing;
}

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
    lines.push_back(fmt::format("the lengths of {}, multiplied by {:.6g}, are those of the other sensor{}{}",
                                extrinsic.scale->sensor, extrinsic.scale->value,
                                extrinsic.scale->certified ? "" : "; this scale is not certified",
                                std::isfinite(extrinsic.scale->stddev) ? "" : "; it is NOT OBSERVABLE"));
  return lines;
}

}  // namespace egocal::tools
