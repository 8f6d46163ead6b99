// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/foreseen.hpp"

#include <algorithm>

#include "diagnosis/motions/standing_still.hpp"
#include "diagnosis/streams/stream_check.hpp"
#include "diagnosis/streams/turning_alike.hpp"

namespace egocal::detail {

bool of_frozen_stream(const Finding& finding) {
  return finding.code.starts_with("frozen_");
}

Foreseen foresee_streams(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                         const DiagnosisOptions& options) {
  Foreseen foreseen{a, b, pairing, options,
                    gather(a, b, {pairing.time_offset, 0, 0}, pairing.max_gap, options)};
  if (foreseen.evidence.given.explained.motions.all.size() < options.motions.least) return foreseen;
  StreamCheckOptions checks;
  checks.metres = options.unit == LengthUnit::metres;
  foreseen.findings = check_streams(a, b, foreseen.evidence.instants, checks);
  if (pairing.mode == Mode::planar)  // level positions are what planar mode is for
    std::erase_if(foreseen.findings, [](const Finding& one) { return one.code.starts_with("flat_"); });
  const bool still = standing_still(foreseen.evidence.instants);
  if (still)  // a pose that never changes is that of an odometry without noise
    std::erase_if(foreseen.findings, [](const Finding& one) {
      return one.code.starts_with("missing_") || one.code.starts_with("flat_") || of_frozen_stream(one);
    });
  if (foreseen.findings.empty() && still)
    foreseen.findings = {too_little_motion(foreseen.evidence.given.explained.motions.all.size(), options)};
  // what is wrong with the streams themselves looks like other mistakes
  if (foreseen.findings.empty())
    foreseen.findings = explain(foreseen.evidence, options);
  else if (std::all_of(foreseen.findings.begin(), foreseen.findings.end(), of_frozen_stream))
    foreseen.beside_frozen = explain(foreseen.evidence, options);
  // of a million poses 8 MB that only explain() looks at
  foreseen.evidence.streams.turning_a = foreseen.evidence.streams.turning_b = {};
  for (std::vector<float>* const turning : {&foreseen.evidence.turning_a, &foreseen.evidence.turning_b})
    *turning = std::vector<float>();
  return foreseen;
}

}  // namespace egocal::detail
