// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/clock_check.hpp"

#include <cmath>

#include "diagnosis/explanations/times/moved_answer.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/in_words.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/pairing/time_offset.hpp"
#include "pairing/offset/offset_fits.hpp"
#include "pairing/offset/turning.hpp"
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

/// Whether motions that do not begin at the stamps fit better with that offset, too. The estimate compares
/// motions at the stamps of one stream, where the noise of the other one depends on how its poses are
/// interpolated: bodies that turn slowly and evenly showed offsets of 0.08 s in this way, by 12 standard
/// deviations. The mean of squares grows with the square of an offset that is wrong, so that k standard
/// deviations of the offset are k / 2 of it.
bool fits_better(const MiddlePart& part, double offset, double than, const DualQuaternion& T_a_b,
                 double max_gap, const ClockCheckOptions& tuning) {
  const Trajectory a = thinned(part.a, 1), b = thinned(part.b, 1);
  if (a.size() < 2 || b.size() < 2) return false;
  TimeOffsetOptions options;
  options.candidate_motions = tuning.instants;
  Schedule schedule;
  OffsetFits fits(a, b, options, to_microseconds(max_gap), schedule);
  for (const double seconds : {than, offset}) {
    const std::int64_t at_b_us = b.front().time_us;
    fits.add({at_b_us + to_microseconds(seconds), at_b_us, 0, 0}, T_a_b);
  }
  while (!schedule.run(1'000'000)) {
  }
  const auto comparison = fits.compare(0, 1);
  return comparison && comparison->sigmas >= tuning.sigmas / 2;
}

}  // namespace

std::optional<TimeOffset> offset_by_turning(const MiddlePart& part, const PairingOptions& pairing,
                                            const ClockCheckOptions& options) {
  TimeOffsetOptions search;
  search.max_gap = pairing.max_gap;
  search.near = pairing.time_offset;
  search.near_by = options.widest;
  search.most_keys = options.instants;
  return estimate_time_offset(part.a, part.b, search);
}

std::optional<Finding> small_clock_offset(const Trajectory& a, const Trajectory& b,
                                          const PairingOptions& pairing, const MiddlePart& part,
                                          const Instants& instants, const std::optional<TimeOffset>& found,
                                          const Answered& answered, const DiagnosisOptions& options) {
  const ClockCheckOptions& tuning = options.clock_check;
  if (!found) return std::nullopt;
  const double more = found->seconds - pairing.time_offset;
  if (!(std::abs(more) > tuning.sigmas * found->stddev) || std::abs(more) > tuning.widest)
    return std::nullopt;
  const Instants corrected =
      synchronised(part.a, part.b, {found->seconds, 0, 0}, pairing.max_gap, 1, options.motions);
  const std::optional<AnswerChange> change =
      answer_change(instants, corrected, answered.T_a_b, options.change);
  if (!change || !likely(*change, answered, tuning)) return std::nullopt;
  if (!fits_better(part, found->seconds, pairing.time_offset, answered.T_a_b, pairing.max_gap, tuning))
    return std::nullopt;
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
  say(finding,
      format("The clocks differ: %+.4f s has to be added to the stamps of {b}, %.0f times its standard "
             "deviation",
             found->seconds, std::abs(more) / found->stddev),
      "{solve}--time-offset auto", "; without it the answer is off by more than it states.");
  return finding;
}

Finding rival_clock_offset(const TimeOffset& offset, const DualQuaternion& T_a_b) {
  Finding finding;
  finding.code = "clock_offset";
  finding.value = offset.rival.value();
  finding.T_a_b = to_pose(T_a_b);
  say(finding, rival_offsets_in_words(std::abs(*offset.rival - offset.seconds)),
      "Add some motion that does not repeat, or give {solve}--time-offset SECONDS");
  return finding;
}

std::string rival_in_words(const Finding& rival, const Pose& T_a_b, const Observability& observability,
                           const DiagnosisOptions& options) {
  const Vector6d difference =
      in_known_directions(frame_a_difference(T_a_b, to_dual_quaternion(rival.T_a_b.value())), observability);
  const double rotation = difference.tail<3>().norm(), translation = difference.head<3>().norm();
  if (!(rotation > options.tolerance_rotation || translation > options.tolerance_translation)) return "";
  return format("%s The answer would be another one, %.3g deg and %s away.", rival.message.c_str(),
                rotation * degrees_per_radian,
                length_in_words(translation, options.unit == LengthUnit::metres).c_str());
}

}  // namespace egocal::detail
