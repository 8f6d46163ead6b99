// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/late_rotations.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/times/late_positions.hpp"
#include "diagnosis/motions/answer_change.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"
#include "egocal/pairing/time_offset.hpp"

namespace egocal::detail {

namespace {

/// Late positions of either stream at this clock; empty: none that are certain. Filters delay: the likelier
/// stream is the one whose rotations are behind those of the other one.
std::optional<LateOfEither> late_of_either(const OnClock& clock, Side behind,
                                           const DiagnosisOptions& options) {
  std::optional<LateOfEither> found = best_late_positions(clock.instants, clock.explained, options, behind);
  if (found && !certain(*found, options)) found.reset();
  return found;
}

/// Time offset by all motions in the middle of the drive, from their rotations alone.
std::optional<TimeOffset> offset_of_rotations(const Evidence& evidence, double max_gap,
                                              const DiagnosisOptions& options,
                                              const LateRotationsOptions& late) {
  const MiddlePart part = middle_part(evidence.streams.a, evidence.streams.b, options.change.most_poses);
  TimeOffsetOptions search;
  search.max_gap = max_gap;
  search.near = evidence.clock.offset;
  search.near_by = late.widest;
  search.most_keys = options.clock_check.instants;
  search.translation_weight = 0;
  return estimate_time_offset(part.a, part.b, search);
}

/// Findings where the offset in force is a compromise.
std::vector<Finding> between_two_clocks(const Evidence& evidence, double max_gap,
                                        const DiagnosisOptions& options, WrongStream& wrong,
                                        const LateRotationsOptions& late) {
  const std::optional<LateOfEither>& first = wrong.late();
  if (!first || first->best.comparison.gain < late.first_gain ||
      first->best.comparison.sigmas < late.first_sigmas)
    return {};
  const std::optional<TimeOffset> found = offset_of_rotations(evidence, max_gap, options, late);
  if (!found) return {};
  const double more = found->seconds - evidence.clock.offset;
  if (!(std::abs(more) > late.sigmas * found->stddev)) return {};
  const OnClock clock = on_clock(evidence, found->seconds, max_gap, options);
  if (clock.explained.motions.all.empty()) return {};
  std::optional<LateOfEither> either = late_of_either(clock, more < 0 ? Side::b : Side::a, options);
  if (!either) return {};
  // both together, against one clock for both
  const Explained& given = evidence.given.explained;
  either->best.comparison = compare(given, either->best.explained);
  if (either->other) either->other->comparison = compare(given, either->other->explained);
  if (!number_explains(either->best.comparison, options)) return {};
  return worded(*either, "At the clock of the rotations");
}

}  // namespace

OnClock on_clock(const Evidence& evidence, double offset, double max_gap, const DiagnosisOptions& options) {
  OnClock result;
  result.instants =
      synchronised(evidence.streams.a, evidence.streams.b, {offset, 0, 0}, max_gap, 1, options.motions);
  result.explained.motions =
      motions_of(result.instants, {}, {}, evidence.stride, options.motions.most, options.motions);
  if (!result.explained.motions.all.empty())
    result.explained.fit = robust_fit(result.explained.motions, options.fit);
  return result;
}

void name_late_rotations(const Evidence& evidence, double max_gap, const DiagnosisOptions& options,
                         WrongStream& wrong, std::vector<Finding>& findings,
                         const LateRotationsOptions& late) {
  const auto clock = std::find_if(findings.begin(), findings.end(), [](const Finding& one) {
    return one.certain && one.code == "clock_offset" && one.value;
  });
  if (std::any_of(findings.begin(), findings.end(),
                  [](const Finding& one) { return certain_of_either(one) && one.code != "clock_offset"; }))
    return;
  if (clock == findings.end()) {
    const std::vector<Finding> found = between_two_clocks(evidence, max_gap, options, wrong, late);
    findings.insert(findings.begin(), found.begin(), found.end());
    return;
  }
  const OnClock corrected = on_clock(evidence, *clock->value, max_gap, options);
  if (corrected.explained.motions.all.empty()) return;
  const std::optional<LateOfEither> found =
      late_of_either(corrected, *clock->value < 0 ? Side::b : Side::a, options);
  if (!found) return;
  const std::vector<Finding> both = worded(*found, "At this clock");
  clock->T_a_b = both.front().T_a_b;
  findings.insert(std::next(clock), both.begin(), both.end());
}

}  // namespace egocal::detail
