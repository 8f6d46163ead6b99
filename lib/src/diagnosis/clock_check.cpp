// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/clock_check.hpp"

#include <cmath>

#include "diagnosis/wording.hpp"
#include "egocal/pairing/time_offset.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

std::optional<Finding> small_clock_offset(const MiddlePart& part, const Instants& instants,
                                          double offset_in_force, double max_gap, const Answered& answered,
                                          const DiagnosisOptions& options) {
  const ClockCheckOptions& tuning = options.clock_check;
  TimeOffsetOptions search;
  search.max_gap = max_gap;
  search.near = offset_in_force;
  search.near_by = tuning.widest;
  search.most_keys = tuning.instants;
  const std::optional<TimeOffset> found = estimate_time_offset(part.a, part.b, search);
  if (!found) return std::nullopt;
  const double more = found->seconds - offset_in_force;
  if (!(std::abs(more) > tuning.sigmas * found->stddev) || std::abs(more) > tuning.widest)
    return std::nullopt;
  const Instants corrected =
      synchronised(part.a, part.b, {found->seconds, 0, 0}, max_gap, 1, options.motions);
  const std::optional<AnswerChange> change =
      answer_change(instants, corrected, answered.T_a_b, options.change);
  if (!change || !(change->cost_ratio < 1)) return std::nullopt;
  bool moves = false;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double size = std::abs(change->size[k]);
    moves |= answered.observability.observable[i] &&
             size > tuning.significant * answered.observability.stddev[i] &&
             size > tuning.significant * std::sqrt(change->variance[k]);
  }
  if (!moves) return std::nullopt;
  Finding finding;
  finding.code = "clock_offset";
  finding.certain = true;
  finding.value = found->seconds;
  finding.improvement = 1 / change->cost_ratio;
  finding.T_a_b = to_pose(frame_a_moved(answered.T_a_b, change->size));
  finding.message = format(
      "The clocks differ: %+.4f s has to be added to the stamps of b, %.0f times its standard deviation; the "
      "answer without it is off by more than it states.",
      found->seconds, std::abs(more) / found->stddev);
  finding.remedy = "--time-offset auto";
  return finding;
}

}  // namespace egocal::detail
