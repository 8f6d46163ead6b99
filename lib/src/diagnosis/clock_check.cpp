// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/clock_check.hpp"

#include <cmath>

#include "diagnosis/wording.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/pairing/time_offset.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// Whether a short look shows that the answer changes.
bool likely(const AnswerChange& change, const Answered& answered, const ClockCheckOptions& options) {
  if (!(change.cost_ratio < 1)) return false;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double size = std::abs(change.size[k]);
    if (answered.observability.observable[i] &&
        size > options.first_look * answered.observability.stddev[i] &&
        size > options.significant * std::sqrt(change.variance[k]))
      return true;
  }
  return false;
}

std::optional<DualQuaternion> answer_at(const Trajectory& a, const Trajectory& b, PairingOptions pairing,
                                        double offset) {
  pairing.time_offset = offset;
  pairing.track_time_offset = false;
  const Problem problem = paired(pairing, a, b).problem();
  if (problem.blocks.empty()) return std::nullopt;
  return solve(problem, Method::dual).minimum;
}

}  // namespace

std::optional<Finding> small_clock_offset(const Trajectory& a, const Trajectory& b,
                                          const PairingOptions& pairing, const MiddlePart& part,
                                          const Instants& instants, const Answered& answered,
                                          const DiagnosisOptions& options) {
  const ClockCheckOptions& tuning = options.clock_check;
  TimeOffsetOptions search;
  search.max_gap = pairing.max_gap;
  search.near = pairing.time_offset;
  search.near_by = tuning.widest;
  search.most_keys = tuning.instants;
  const std::optional<TimeOffset> found = estimate_time_offset(part.a, part.b, search);
  if (!found) return std::nullopt;
  const double more = found->seconds - pairing.time_offset;
  if (!(std::abs(more) > tuning.sigmas * found->stddev) || std::abs(more) > tuning.widest)
    return std::nullopt;
  const Instants corrected =
      synchronised(part.a, part.b, {found->seconds, 0, 0}, pairing.max_gap, 1, options.motions);
  const std::optional<AnswerChange> change =
      answer_change(instants, corrected, answered.T_a_b, options.change);
  if (!change || !likely(*change, answered, tuning)) return std::nullopt;
  // of these poses both times: the answer may be of more
  const std::optional<DualQuaternion> as_given = answer_at(a, b, pairing, pairing.time_offset),
                                      on_one_clock = answer_at(a, b, pairing, found->seconds);
  if (!as_given || !on_one_clock) return std::nullopt;
  const Vector6d moved = frame_a_difference(*as_given, *on_one_clock);
  bool matters = false;
  for (std::size_t i = 0; i < 6; ++i)
    matters |= answered.observability.observable[i] && std::abs(moved[static_cast<Eigen::Index>(i)]) >
                                                           tuning.matters * answered.observability.stddev[i];
  if (!matters) return std::nullopt;
  Finding finding;
  finding.code = "clock_offset";
  finding.certain = true;
  finding.value = found->seconds;
  finding.improvement = 1 / change->cost_ratio;
  finding.T_a_b = to_pose(frame_a_moved(answered.T_a_b, moved));
  finding.message = format(
      "The clocks differ: %+.4f s has to be added to the stamps of b, %.0f times its standard deviation; "
      "without it the answer is off by more than it states.",
      found->seconds, std::abs(more) / found->stddev);
  finding.remedy = "--time-offset auto";
  return finding;
}

}  // namespace egocal::detail
