// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "diagnosis/explanations/times/clock.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/diagnosis/options.hpp"

namespace egocal::detail {

/// One way to understand the two streams, with the extrinsic that suits it best.
struct Explanation {
  std::string code;  ///< of the finding; empty: as given
  PoseReading read_a, read_b;
  ClockModel clock;
  double scale = 1;  ///< of b, besides the readings
  Explained explained;
};

/// The drive as the explanations see it.
struct Evidence {
  std::vector<float> turning_a, turning_b;
  Streams streams;   ///< as given, with the clock offset applied in `clock`
  ClockModel clock;  ///< in force
  Instants instants;
  int stride = 1;  ///< of the motions that are compared
  Explanation given;
  Explanation scaled;  ///< the same with a free scale of b
};

/// Synchronises, chooses the length of the motions, and fits the streams as given. The stride is the one at
/// which some reading fits best, among those that leave enough independent motions.
Evidence gather(const Trajectory& a, const Trajectory& b, const ClockModel& clock, double max_gap,
                const DiagnosisOptions& options);

/// Findings about the streams: readings, scale, clock. In the order of importance; answers included.
std::vector<Finding> explain(const Evidence& evidence, const DiagnosisOptions& options);

/// The scale of b differs from one by much more than its own standard deviation, whatever the single motions
/// say, by however little. Only where nothing else explains the streams: any contradiction has some best
/// scale.
std::optional<Finding> wrong_scale(const Evidence& evidence, const DiagnosisOptions& options);

/// wrong_scale() by motions of all lengths together, where the long ones seem to have a scale: on a machine
/// that is shaken faster than it is measured the standard deviation of the long ones is mostly that of the
/// shaking. Uncertain where it is small, or differs from one by fewer of its standard deviations: right
/// odometries differ as much, so that it is of use where the answer at it is another one. pairing: as for the
/// answer.
std::optional<Finding> wrong_scale_of_drive(const Evidence& evidence, const PairingOptions& pairing,
                                            const DiagnosisOptions& options);

}  // namespace egocal::detail
