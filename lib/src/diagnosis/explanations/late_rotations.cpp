// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/late_rotations.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/late_positions.hpp"
#include "diagnosis/motions/answer_change.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/pairing/time_offset.hpp"

namespace egocal::detail {

namespace {

struct OnClock {
  Instants instants;
  Explained explained;  ///< no motions: none was found
};

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

/// Filters delay: the stream whose rotations are behind those of the other one.
std::optional<LatePositions> late_of_either(const OnClock& clock, Side behind,
                                            const DiagnosisOptions& options) {
  for (const std::optional<Side> side : {std::optional(behind), std::optional<Side>()})
    if (std::optional<LatePositions> found =
            best_late_positions(clock.instants, clock.explained, options, side);
        found && certain(*found, options))
      return found;
  return std::nullopt;
}

/// clock: "At this clock".
Finding worded_at(const char* clock, const LatePositions& found) {
  Finding finding = worded(found);
  FindingWords words = finding.words;
  words.claim[0] = 't';  // "The positions of"
  words.claim = std::string(clock) + " " + words.claim;
  say(finding, std::move(words));
  return finding;
}

/// Of all motions of the middle of the drive, by their rotations alone.
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

/// Where the offset in force is a compromise.
std::optional<Finding> between_two_clocks(const Evidence& evidence, double max_gap,
                                          const DiagnosisOptions& options, WrongStream& wrong,
                                          const LateRotationsOptions& late) {
  const std::optional<LatePositions>& first = wrong.late();
  if (!first || first->comparison.gain < late.first_gain || first->comparison.sigmas < late.first_sigmas)
    return std::nullopt;
  const std::optional<TimeOffset> found = offset_of_rotations(evidence, max_gap, options, late);
  if (!found) return std::nullopt;
  const double more = found->seconds - evidence.clock.offset;
  if (!(std::abs(more) > late.sigmas * found->stddev)) return std::nullopt;
  const OnClock clock = on_clock(evidence, found->seconds, max_gap, options);
  if (clock.explained.motions.all.empty()) return std::nullopt;
  std::optional<LatePositions> best = late_of_either(clock, more < 0 ? Side::b : Side::a, options);
  if (!best) return std::nullopt;
  // both together, against one clock for both
  best->comparison = compare(evidence.given.explained, best->explained);
  if (!number_explains(best->comparison, options)) return std::nullopt;
  return worded_at("At the clock of the rotations", *best);
}

}  // namespace

void name_late_rotations(const Evidence& evidence, double max_gap, const DiagnosisOptions& options,
                         WrongStream& wrong, std::vector<Finding>& findings,
                         const LateRotationsOptions& late) {
  const auto clock = std::find_if(findings.begin(), findings.end(), [](const Finding& one) {
    return one.certain && one.code == "clock_offset" && one.value;
  });
  if (std::any_of(findings.begin(), findings.end(),
                  [](const Finding& one) { return one.certain && one.code != "clock_offset"; }))
    return;
  if (clock == findings.end()) {
    if (std::optional<Finding> found = between_two_clocks(evidence, max_gap, options, wrong, late))
      findings.insert(findings.begin(), *std::move(found));
    return;
  }
  const OnClock corrected = on_clock(evidence, *clock->value, max_gap, options);
  if (corrected.explained.motions.all.empty()) return;
  const std::optional<LatePositions> found =
      late_of_either(corrected, *clock->value < 0 ? Side::b : Side::a, options);
  if (!found) return;
  Finding finding = worded_at("At this clock", *found);
  clock->T_a_b = finding.T_a_b;
  findings.insert(std::next(clock), std::move(finding));
}

}  // namespace egocal::detail
