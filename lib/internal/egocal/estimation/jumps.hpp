// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "egocal/problem/problem.hpp"

namespace egocal {

/// A motion between neighbouring instants, as the search for jumps sees it.
struct Step {
  DualQuaternion a, b;  ///< motions of the sensors (planar mode: seen from the ground planes)
  bool usable = true;   ///< false: the two instants are in different chains
};

/// A step with what every look at it needs: the newest steps are looked at several times.
struct MeasuredStep {
  explicit MeasuredStep(const Step& given);

  Step step;
  Pose a, b;          ///< of the step
  double angle = 0;   ///< by which both sensors turn at least [rad]
  double length = 0;  ///< by which both move at least [m]
};

/// What a jump affects. A translation that jumps leaves the rotation of the motions across it valid.
enum class Jump : std::uint8_t { none, translation, all };

/// Tuning of find_jumps().
struct JumpOptions {
  /// A residual is a jump where it exceeds the typical one by (q75 / q25)^(tail / 2), a log-normal
  /// extrapolation of its own quartiles. 5 puts Gaussian noise at 7 standard deviations; measured on the
  /// benchmark in docs/accuracy.md (six of KITTI's 0930_27, none of KITTI 07).
  double tail = 5;
  /// The ratio sqrt(q75 / q25) is limited to this range: Gaussian noise in three dimensions has 1.36; above
  /// 1.7 (14 times the typical residual) the quartiles say too little about the tail.
  double least_ratio = 1.36, most_ratio = 1.7;
  /// Where the noise has heavy tails, a step loses weight if its residual is larger than this many times the
  /// typical one: its variance is then taken to be (residual / (doubtful * typical))^4 times the typical one.
  /// Seven are 11 standard deviations of Gaussian noise.
  double doubtful = 7;
  /// Tails are heavy where more than this part of the steps are doubtful or jumps. Below, far steps are
  /// judged one by one as jumps. KITTI 05 and 07 have one in a thousand, 0930_27 one in twenty
  /// (docs/accuracy.md).
  double heavy_tail = 0.02;
  /// Tails are not judged by fewer far steps than this, however few the steps: four of a hundred are rarely
  /// chance. Study: tests/bench/heavy_tail_study.cpp.
  double least_far = 4;
  /// Largest part of the steps that are jumps: beyond, there is no majority to judge by.
  double most_jumps = 0.4;
  /// Residuals below these are the rounding of what sensors send [rad, m]: the seventh digit of a quaternion,
  /// a micrometre.
  double rotation_floor = 1e-7, translation_floor = 1e-6;
  /// Steps with a smaller weight do not count in what is typical. A residual at its limit has a quarter.
  double least_weight = 0.3;
  std::size_t least_steps = 8;  ///< fewer steps have no quartiles: two of them on either side
  /// Graduated non-convexity: the loss is sharpened by this factor a round. Yang et al. 2020 take 1.4, which
  /// needs four times the rounds; the jumps of docs/accuracy.md are found with 4.
  double sharpen = 4;
  int most_rounds = 24;  ///< a limit: a residual of 4^24 times the limit is none
  /// Weight of rotation to translation [m^2] before any residual is known: a centimetre for a milliradian.
  double first_balance = 100;
};

/// What is known of one step.
struct StepVerdict {
  Jump jump = Jump::none;
  double extra_variance = 0;  ///< beyond what is typical, in typical variances of a step
};

/// Where one sensor's odometry jumps: tracking lost and found again elsewhere, a slip, a single wrong step.
/// Screw congruence sees one component of such a jump; the residual of A T = T B sees all six. Rotation and
/// translation are judged apart, against their own quartiles, both absolutely and relative to the size of the
/// step, so noise may grow with motion.
///
/// q: the extrinsic to judge by (planar mode: T_p); empty: found by graduated non-convexity over the steps
/// and `before`, statistics of earlier steps, so that a first turn is never taken for a jump. Deterministic.
/// Returns one verdict per step.
std::vector<StepVerdict> find_jumps(std::span<const MeasuredStep> steps, const Statistics& before, Mode mode,
                                    const std::optional<DualQuaternion>& q, const JumpOptions& options = {});

}  // namespace egocal
