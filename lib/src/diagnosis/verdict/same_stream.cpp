// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/same_stream.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "diagnosis/motions/fit.hpp"
#include "diagnosis/streams/chord_copy.hpp"
#include "diagnosis/streams/copied_positions.hpp"
#include "diagnosis/streams/copied_rotations.hpp"
#include "diagnosis/streams/stream_check.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"

namespace egocal::detail {

namespace {

bool filled(const Finding& finding) {
  return finding.code.starts_with("filled_");
}

bool turned_axes(const Finding& finding) {
  return finding.code.starts_with("axes_");
}

StreamCheckOptions checks_of(const DiagnosisOptions& options) {
  StreamCheckOptions checks;
  checks.metres = options.unit == LengthUnit::metres;
  if (options.unit == LengthUnit::unknown) {
    const double of_a_metre = options.tolerance_translation / DiagnosisOptions().tolerance_translation;
    checks.close *= of_a_metre;
    checks.known_translation *= of_a_metre;
  }
  return checks;
}

/// One stream was made from the other as a whole, or its rotations were. to_rounding: made_from_each_other().
std::optional<Finding> made_stream(const Evidence& evidence, const Fit& fit,
                                   const std::vector<Finding>& to_rounding, std::vector<Finding>& findings) {
  const Streams& streams = evidence.streams;
  if (std::optional<Finding> copy = chord_copy(streams.a, streams.b, evidence.clock, streams.max_gap)) {
    std::erase_if(findings, filled);
    return copy;
  }
  if (!to_rounding.empty()) return to_rounding.front();
  if (std::optional<Finding> rotations =
          copied_rotations(streams.a, streams.b, evidence.clock, streams.max_gap))
    return rotations;
  std::optional<Finding> rotations = exactly_copied_rotations(fit, evidence.given.explained.motions);
  // where a map corrects an odometry, the odometry goes straight on
  if (rotations) std::erase_if(findings, filled);
  return rotations;
}

/// Rotations that were made from the other stream's by a wrong extrinsic, beside positions of another world,
/// look like axes. That they were made comes first: with the axes corrected, the answer is what was put in.
void name_copied_rotations_of_axes(const Evidence& evidence, std::vector<Finding>& findings) {
  const CopiedRotationsOptions copied;
  for (const Finding& finding : findings)
    if (finding.improvement > copied.without_noise) return;
  const Streams& streams = evidence.streams;
  if (std::optional<Finding> rotations =
          copied_rotations(streams.a, streams.b, evidence.clock, streams.max_gap))
    findings.insert(findings.begin(), *std::move(rotations));
}

}  // namespace

void name_same_stream(const Evidence& evidence, const Answered& answered, const DiagnosisOptions& options,
                      Diagnosis& result) {
  std::vector<Finding>& findings = result.findings;
  if (std::any_of(findings.begin(), findings.end(),
                  [](const Finding& one) { return one.code == "same_stream"; }))
    return;
  const auto explains = [](const Finding& one) { return certain_of_either(one) && !filled(one); };
  const auto explains_otherwise = [&](const Finding& one) { return explains(one) && !turned_axes(one); };
  if (std::any_of(findings.begin(), findings.end(), explains_otherwise)) return;
  const std::vector<Finding> to_rounding = made_from_each_other(result.fit);
  if (to_rounding.empty())
    if (std::optional<Finding> positions =
            copied_positions(evidence.instants, evidence.given.explained.motions)) {
      std::erase_if(findings, turned_axes);
      findings.push_back(*std::move(positions));
      return;
    }
  if (std::any_of(findings.begin(), findings.end(), explains)) {
    name_copied_rotations_of_axes(evidence, findings);
    return;
  }
  if (std::optional<Finding> made = made_stream(evidence, result.fit, to_rounding, findings)) {
    findings.push_back(*std::move(made));
    return;
  }
  if (std::any_of(findings.begin(), findings.end(), filled)) return;
  // that one stream was made from the other explains an answer that is the identity, too
  for (Finding& finding : in_one_frame(answered, checks_of(options))) findings.push_back(std::move(finding));
}

}  // namespace egocal::detail
