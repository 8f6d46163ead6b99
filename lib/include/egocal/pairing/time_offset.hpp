// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// Options of the estimate of a time offset. Their study: tests/lib/test_time_offset.cpp, over noise,
/// glitches, drift and rates.
struct TimeOffsetOptions {
  /// Poses further apart are not interpolated between [s]. The estimate itself never bridges more than 20
  /// periods of the slower stream: what was interpolated over longer says nothing about time.
  double max_gap = 0.5;
  double least_overlap = 5;  ///< offsets at which the streams share less than this are not considered [s]
  /// Poses closer in time are skipped [s]. 100 Hz resolve a millisecond; faster streams only cost time.
  double least_spacing = 0.009;
  /// At most this many instants are compared in one pass, spread over the whole drive: half an hour at 10 Hz
  /// determines an offset to microseconds.
  std::size_t most_keys = 20'000;
  double motion = 0.5;  ///< length of the compared motions [s]: turns stand out of the noise of short steps
  /// Weight of translations against a rotation weight of 1 [1/m^2]: rotations show time, translations only
  /// with the lever arm.
  double translation_weight = 0.01;
  /// A pose is a glitch, and a motion an outlier, where it differs by this many typical differences.
  double outlier = 8;
  /// A drift is corrected where it is this many standard deviations away from zero.
  double drift_sigmas = 5;
  double most_drift = 0.01;          ///< larger rates are taken for errors [s/s]; a poor quartz is at 1e-4
  double least_drift_duration = 30;  ///< shorter drives are taken to have no drift [s]
  /// An offset to search near, with `near_by` on both sides [s]; empty: all offsets at which streams overlap.
  /// Among offsets that fit equally well, the nearest one to this is taken, and no doubt remains.
  std::optional<double> near{};
  double near_by = 1;

  /// Spacing of the grid on which the angles of both streams are correlated: the period of the slower stream,
  /// within these bounds, and at least a quarter of that period [s]. The refinement does the rest.
  double finest_grid = 0.05, coarsest_grid = 0.25;
  /// The stamps of the slower stream give the instants of the refinement: those of a only where b's period is
  /// below this part of a's. Streams of one rate jitter by a few percent.
  double least_period_ratio = 0.9;
  /// Differences of angles and lengths that are rounding alone [rad, m], as CongruenceOptions has them.
  double angle_floor = 1e-6, length_floor = 1e-5;
  /// A pose is a glitch only where the way over it is longer by more than this part of the way past it.
  double least_detour = 0.5;
  /// Stamps that are further apart than the known time of the drive times this are damaged: only the part
  /// with most poses is looked at, so that memory does not grow with the span of the stamps.
  std::int64_t most_sparse = 16;
  /// Rounds in which glitches are removed: of neighbouring ones only the furthest is found in each.
  int glitch_rounds = 4;
  /// Parts of a long drive that are searched one after the other, outwards from the best [s], and how fast
  /// the offset may change between them [s/s]: a clock that is off by half a percent gains 0.3 s in one.
  double part = 60, part_drift = 0.005;
  /// A part with a lower correlation hardly turns and shows no offset.
  double part_correlation = 0.5;
  /// A drift smears the correlation of a long drive. Where it is below this, the part of this length that
  /// turns most is searched by itself [s].
  double smeared_correlation = 0.7, liveliest_part = 300;
  /// The refinement compares the costs at three offsets, at least this far apart [s], or a part of the slower
  /// stream's period: closer ones differ by less than the noise of the cost.
  double least_arm = 0.02;
  /// Instants compared by the refinement are at least this far apart [s]: 20 Hz show all that odometry has to
  /// say about time.
  double key_spacing = 0.05;
  /// Rounds of the refinement at most: each halves the distance of the three offsets, from a quarter of a
  /// second down to 2 ms in seven.
  int most_rounds = 8;
  /// A drift that changes the offset by less than this from the middle of the drive to its ends is not
  /// applied [s]: an offset is not known to better.
  double least_drift_effect = 5e-4;
  /// Motion that repeats turns alike at several offsets. Candidates are the lags at which the angles
  /// correlate with at least `candidate_significance` of the best one's significance and by `candidate_depth`
  /// of it more than around them: the `most_candidates` most significant ones, the one nearest to 0, and 0.
  /// They are compared by how well an extrinsic explains this number of motions. Study: docs/method.md,
  /// "Clocks".
  double candidate_significance = 0.5, candidate_depth = 0.1;
  std::size_t most_candidates = 8, candidate_motions = 300;
  /// A candidate is worse where its squares are larger by this mean logarithm, and where the parts of the
  /// drive say so by chance with at most this probability; otherwise it fits as well. Study: those that
  /// repeat a drive have chances down to 5e-4, the others 1e-7 at most.
  double candidate_gain = 0.1, candidate_chance = 1e-5;
};

/// What has to be added to the stamps of b so that both streams run on the clock of a.
struct TimeOffset {
  double seconds = 0;  ///< at `at_us` [s]
  /// Standard deviation of `seconds`, from how much the parts of the drive differ [s]. Where other offsets
  /// fit as well, it is the distance of the farthest one of them that was compared.
  double stddev = 0;
  double correlation = 0;  ///< of the angles that both turn by, [-1, 1]; below about 0.5 do not trust it
  double rate = 0;         ///< by how much `seconds` grows per second of b's clock: the drift [s/s]
  double rate_stddev = 0;  ///< of `rate`; infinite where the drive is too short
  std::int64_t at_us = 0;  ///< a time on the clock of b, in the middle of the drive [us]
  bool drifts = false;     ///< the rate is significant: only then it is applied
  double inliers = 0;      ///< part of the compared motions that agree, [0, 1]
  /// The nearest other offset that fits as well: the motion repeats [s]. Empty: none does.
  std::optional<double> rival{};
};

/// A stamp of b on the clock of a [us].
std::int64_t on_clock_of_a(const TimeOffset& offset, std::int64_t time_us);
/// The poses of b with stamps on the clock of a.
Trajectory on_clock_of_a(const TimeOffset& offset, Trajectory b);

/// The time offset of two trajectories. Empty where they are too short, never turn or do not match.
/// Deterministic. Thread-safe.
std::optional<TimeOffset> estimate_time_offset(const Trajectory& a, const Trajectory& b,
                                               const TimeOffsetOptions& options = {});

}  // namespace egocal
