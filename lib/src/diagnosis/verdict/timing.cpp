// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/timing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "diagnosis/explanations/times/clock_check.hpp"
#include "diagnosis/explanations/times/late_positions.hpp"
#include "diagnosis/motions/answer_change.hpp"
#include "diagnosis/streams/undersampling.hpp"
#include "diagnosis/verdict/rounding.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

bool of_clock(const Finding& finding) {
  return finding.code.starts_with("clock_");
}

}  // namespace

void look_at_times(const Foreseen& foreseen, Answered& answered, Diagnosis& result) {
  const Trajectory &a = foreseen.a, &b = foreseen.b;
  const PairingOptions& pairing = foreseen.pairing;
  const DiagnosisOptions& options = foreseen.options;
  if (answered.problem.mode == Mode::planar) return;
  const auto certain = [&](const auto& which) {
    return std::find_if(result.findings.begin(), result.findings.end(),
                        [&](const Finding& one) { return certain_of_either(one) && which(one); });
  };
  if (certain([](const Finding& one) { return !of_clock(one); }) != result.findings.end()) return;
  const MiddlePart part = middle_part(a, b, options.change.most_poses);
  const Instants instants =
      synchronised(part.a, part.b, {pairing.time_offset, 0, 0}, pairing.max_gap, 1, options.motions);
  const std::array<double, 6> of_interpolation = interpolation_stddev(instants, answered.T_a_b, options);
  auto clock = certain(of_clock);
  if (clock == result.findings.end()) {
    const std::optional<TimeOffset> found =
        foreseen.has_offset ? foreseen.offset : offset_by_turning(part, pairing, options.clock_check);
    if (std::optional<Finding> offset =
            small_clock_offset(a, b, pairing, part, instants, found, answered, options)) {
      // the same with less certainty
      std::erase_if(result.findings, of_clock);
      clock = result.findings.insert(result.findings.begin(), *std::move(offset));
    }
  }
  Vector6d moved = Vector6d::Zero();
  if (clock != result.findings.end() && clock->T_a_b)
    moved = frame_a_difference(answered.T_a_b, to_dual_quaternion(*clock->T_a_b));
  const Evidence& evidence = foreseen.evidence;
  const double steps = instants.period > 0 ? evidence.stride * evidence.instants.period / instants.period : 1;
  const std::array<double, 6> of_rounding =
      rounding_stddev(part, instants, static_cast<int>(std::lround(steps)), evidence.given.explained.motions,
                      answered.T_a_b, pairing.time_offset, pairing.max_gap, options);
  for (std::size_t i = 0; i < 6; ++i)
    answered.timing_stddev[i] =
        std::hypot(of_interpolation[i], moved[static_cast<Eigen::Index>(i)], of_rounding[i]);
  result.timing_stddev = answered.timing_stddev;
  if (std::optional<Finding> finding =
          undersampled(instants, answered, of_interpolation, options.undersampling))
    result.findings.push_back(*std::move(finding));
}

}  // namespace egocal::detail
