// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/common/with_nominal_part.hpp"

#include <utility>

#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::tools {

namespace {

/// What a finding says of the nominal value it says of what is given.
void word_for_part(const Pose& part, Calibration& calibration) {
  for (Finding& finding : calibration.findings) {
    if (finding.code != "nominal") continue;
    const bool is_reason = calibration.reason == finding.message;
    FindingWords words = finding.words;
    words.claim = "Only " + known_in_words(part) + " of the nominal value is given. " + words.claim;
    say(finding, std::move(words));
    if (is_reason) calibration.reason = finding.message;
  }
}

}  // namespace

Calibration with_nominal_part(const std::optional<Pose>& part, NominalOf of, CalibrationOptions& options,
                              const Calibrate& calibrate, std::string& note) {
  Calibration calibration = calibrate(options);
  if (!part) return calibration;
  const std::optional<DualQuaternion> whole =
      completed_nominal(*part, calibration.problem, to_dual_quaternion(calibration.T_a_b), of);
  if (!whole) {
    note = "the nominal value gives " + known_in_words(*part) +
           ", and the motions hide more than that: nothing is taken from it";
    return calibration;
  }
  options.pairing.prior = whole;
  calibration = calibrate(options);
  word_for_part(*part, calibration);
  return calibration;
}

}  // namespace egocal::tools
