// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include "egocal/diagnosis/options.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal {

/// What was answered, for diagnose().
struct Answered {
  DualQuaternion T_a_b;
  Observability observability;
  PairingCounts counts;
  Problem problem;
  int stride = 1;                     ///< of its motions, in instants
  double seconds = 0;                 ///< that the motions took; 0: unknown
  Platform platform = Platform::car;  ///< where the goal names none
  Problem minimised{};                ///< by T_a_b, where that is not `problem`; no blocks: it is
  /// What an unknown scale adds to the standard deviation of each direction [m, rad]; 0 where it is known.
  std::array<double, 6> scale_stddev{};
  /// What the times of the poses add (Diagnosis::timing_stddev); diagnose() finds it.
  std::array<double, 6> timing_stddev{};
};

/// Whether the answer can be used, and if not, why: tries other readings of the streams, scale, clock, ground
/// planes and a moved mount on the motions of all poses, none rejected. `pairing`: as for the answer, with
/// the time offset in force. Deterministic; about a tenth of a second for 2,000 poses. Thread-safe.
Diagnosis diagnose(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                   const Answered& answered, const DiagnosisOptions& options = {});

/// The same from motion pairs, which have no poses to read otherwise: fit and verdict only.
Diagnosis diagnose(std::span<const MotionPair> pairs, const Answered& answered,
                   const DiagnosisOptions& options = {});

/// The same from what was answered alone: no other explanation is tried, and the fit is not measured.
Diagnosis diagnose(const Answered& answered, const DiagnosisOptions& options = {});

}  // namespace egocal
