// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/pair/samples.hpp"

#include <string>

#include "egocal/error.hpp"
#include "egocal/in_words.hpp"

namespace egocal::tools {

namespace {

SampleOptions options_of(const SolveRequest& request) {
  const CalibrationOptions& calibration = request.calibration;
  SampleOptions options;
  options.read_a = calibration.read_a;
  options.read_b = calibration.read_b;
  if (request.samples->eye_to_hand) options.read_a.invert = !options.read_a.invert;
  (calibration.scale_side == Side::a ? options.read_a : options.read_b).scale = calibration.scale;
  options.prior = calibration.pairing.prior;
  options.diagnosis = calibration.diagnosis;
  return options;
}

}  // namespace

void answer_samples(const SolveRequest& request, const Trajectory& a, const Trajectory& b,
                    SolveResult& result) {
  try {
    result.matched = match_samples(a, b);
    result.samples = calibrate_samples(result.matched.samples, options_of(request));
  } catch (const Error& error) {
    throw Error(request.source.a + ", " + request.source.b + ": " + error.what());
  }
  result.calibration = result.samples->calibration;
  result.calibration.scale_applied = request.calibration.scale;
  result.method = "dual";
  result.eye_to_hand = request.samples->eye_to_hand;
  if (result.matched.without_partner > 0)
    result.warnings.push_back("no partner, not used: " + counted(result.matched.without_partner, "row"));
  const SampleCalibration& samples = *result.samples;
  if (samples.repeated > 0)
    result.warnings.push_back("repeat another row exactly, count once: " + counted(samples.repeated, "row"));
  if (samples.different > 0 && samples.different + samples.repeated < samples.residuals.size())
    result.warnings.push_back("samples that share a pose count as one: " +
                              counted(samples.different, "different sample"));
  if (!result.matched.by_stamp)
    result.warnings.push_back("the stamps do not agree: row i of a belongs to row i of b");
}

}  // namespace egocal::tools
