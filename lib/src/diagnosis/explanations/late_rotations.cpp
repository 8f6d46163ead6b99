// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/late_rotations.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "diagnosis/explanations/late_positions.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

void name_late_rotations(const Evidence& evidence, double max_gap, const DiagnosisOptions& options,
                         std::vector<Finding>& findings) {
  const auto clock = std::find_if(findings.begin(), findings.end(), [](const Finding& one) {
    return one.certain && one.code == "clock_offset" && one.value;
  });
  if (clock == findings.end()) return;
  if (std::any_of(findings.begin(), findings.end(),
                  [](const Finding& one) { return one.certain && one.code != "clock_offset"; }))
    return;
  const Instants instants = synchronised(evidence.streams.a, evidence.streams.b, {*clock->value, 0, 0},
                                         max_gap, 1, options.motions);
  Explained corrected;
  corrected.motions = motions_of(instants, {}, {}, evidence.stride, options.motions.most, options.motions);
  if (corrected.motions.all.empty()) return;
  corrected.fit = robust_fit(corrected.motions, options.fit);
  // filters delay: the stream whose rotations are behind those of the other one
  std::optional<Finding> late =
      late_positions(instants, corrected, options, *clock->value < 0 ? Side::b : Side::a);
  if (!late) late = late_positions(instants, corrected, options);
  if (!late) return;
  FindingWords words = late->words;
  words.claim = "At this clock: " + words.claim;
  say(*late, std::move(words));
  clock->T_a_b = late->T_a_b;
  findings.insert(std::next(clock), *std::move(late));
}

}  // namespace egocal::detail
