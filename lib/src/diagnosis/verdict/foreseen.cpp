// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/foreseen.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "diagnosis/explanations/contents/moved_twin.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "diagnosis/streams/stream_check.hpp"
#include "diagnosis/streams/turning_alike.hpp"

namespace egocal::detail {

bool of_frozen_stream(const Finding& finding) {
  return finding.code.starts_with("frozen_");
}

namespace {

/// What is wrong with the streams themselves.
std::vector<Finding> faults_of_streams(const Foreseen& foreseen) {
  StreamCheckOptions checks;
  checks.metres = foreseen.options.unit == LengthUnit::metres;
  std::vector<Finding> findings = check_streams(foreseen.a, foreseen.b, foreseen.evidence.instants, checks);
  if (foreseen.pairing.mode == Mode::planar)  // level positions are what planar mode is for
    std::erase_if(findings, [](const Finding& one) { return one.code.starts_with("flat_"); });
  if (!standing_still(foreseen.evidence.instants)) return findings;
  // a pose that never changes is that of an odometry without noise
  std::erase_if(findings, [](const Finding& one) {
    return one.code.starts_with("missing_") || one.code.starts_with("flat_") || of_frozen_stream(one);
  });
  if (findings.empty())
    findings = {too_little_motion(foreseen.evidence.given.explained.motions.all.size(), foreseen.options)};
  return findings;
}

/// Pairing rejects what a frozen stream repeats. What is left may be misread, or have moved; empty: too
/// little is left.
std::optional<Foreseen> without_what_is_frozen(const Foreseen& all) {
  if (all.findings.empty() || !std::all_of(all.findings.begin(), all.findings.end(), of_frozen_stream))
    return std::nullopt;
  auto awake =
      std::make_shared<const AwakeStreams>(without_frozen_poses(all.a, all.b, all.pairing.time_offset));
  const DiagnosisOptions& options = all.options;
  Foreseen rest{awake->a, awake->b, all.pairing, options,
                gather(awake->a, awake->b, all.evidence.clock, all.pairing.max_gap, options)};
  if (rest.evidence.given.explained.motions.all.size() < options.motions.least) return std::nullopt;
  rest.findings = faults_of_streams(rest);
  std::erase_if(rest.findings, of_frozen_stream);
  rest.frozen = all.findings;
  rest.awake = std::move(awake);
  return rest;
}

}  // namespace

Foreseen foresee_streams(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                         const DiagnosisOptions& options) {
  Foreseen all{a, b, pairing, options, gather(a, b, {pairing.time_offset, 0, 0}, pairing.max_gap, options)};
  if (all.evidence.given.explained.motions.all.size() < options.motions.least) return all;
  all.findings = faults_of_streams(all);
  std::optional<Foreseen> rest = without_what_is_frozen(all);
  Foreseen foreseen = rest ? *std::move(rest) : std::move(all);
  // what is wrong with the streams themselves looks like other mistakes
  if (foreseen.findings.empty()) {
    foreseen.findings = explain(foreseen.evidence, options);
    doubt_inversion(foreseen.evidence, options, foreseen.findings);
  }
  // of a million poses 8 MB that only explain() looks at
  foreseen.evidence.streams.turning_a = foreseen.evidence.streams.turning_b = {};
  for (std::vector<float>* const turning : {&foreseen.evidence.turning_a, &foreseen.evidence.turning_b})
    *turning = std::vector<float>();
  return foreseen;
}

}  // namespace egocal::detail
