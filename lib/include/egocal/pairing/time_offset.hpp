// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
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
  /// Of translation against a rotation weight of 1 [1/m^2]: rotations show time, translations only with the
  /// lever arm.
  double translation_weight = 0.01;
  /// A pose is a glitch, and a motion an outlier, where it differs by this many typical differences.
  double outlier = 8;
  /// A drift is corrected where it is this many standard deviations away from zero.
  double drift_sigmas = 5;
  double most_drift = 0.01;          ///< larger rates are taken for errors [s/s]; a poor quartz is at 1e-4
  double least_drift_duration = 30;  ///< shorter drives are taken to have no drift [s]
  /// An offset to search near, with `near_by` on both sides [s]; empty: all offsets at which streams overlap.
  std::optional<double> near{};
  double near_by = 1;

  /// Spacing of the grid on which the angles of both streams are correlated: the period of the slower stream,
  /// within these bounds, and at least a quarter of that period [s]. The refinement does the rest.
  double finest_grid = 0.05, coarsest_grid = 0.25;
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
  /// The refinement compares the costs at three offsets, at least this far apart [s], or half a period of the
  /// slower stream: closer ones differ by less than the noise of the cost.
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
};

/// What has to be added to the stamps of b so that both streams run on the clock of a.
struct TimeOffset {
  double seconds = 0;      ///< at `at_us` [s]
  double stddev = 0;       ///< of `seconds`, from how much the parts of the drive differ [s]
  double correlation = 0;  ///< of the angles that both turn by, [-1, 1]; below about 0.5 do not trust it
  double rate = 0;         ///< by how much `seconds` grows per second of b's clock: the drift [s/s]
  double rate_stddev = 0;  ///< of `rate`; infinite where the drive is too short
  std::int64_t at_us = 0;  ///< a time on the clock of b, in the middle of the drive [us]
  bool drifts = false;     ///< the rate is significant: only then it is applied
  double inliers = 0;      ///< part of the compared motions that agree, [0, 1]
};

/// A stamp of b on the clock of a [us].
std::int64_t on_clock_of_a(const TimeOffset& offset, std::int64_t time_us);
/// The poses of b with stamps on the clock of a.
Trajectory on_clock_of_a(const TimeOffset& offset, Trajectory b);

/// The search for a time offset in small pieces, so that it can be spread over the poses of a live stream.
/// The result depends on the trajectories and options alone, not on how the work is divided.
///
/// The angle that a rigid body turns by between two instants is the same for every sensor on it, whatever the
/// extrinsic: correlated over all offsets at which the streams overlap, it finds the offset of clocks that
/// share nothing. Then the certified minimum of the cost (18) as a function of offset and drift is minimised
/// over motions that are not outliers. Time and memory are bounded by the number of poses (n log n), never by
/// the span of their stamps.
class TimeOffsetSearch {
 public:
  /// Poses that are not valid, or whose stamps do not increase, are skipped.
  TimeOffsetSearch(const Trajectory& a, const Trajectory& b, const TimeOffsetOptions& options = {});
  ~TimeOffsetSearch();
  TimeOffsetSearch(TimeOffsetSearch&&) noexcept;
  TimeOffsetSearch& operator=(TimeOffsetSearch&&) noexcept;

  /// Does the next pieces of work, of about `work` poses together. Returns whether the search is finished.
  bool step(std::size_t work);
  /// Does what is left. Empty where the streams are too short, never turn or do not match.
  std::optional<TimeOffset> finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The whole search at once.
std::optional<TimeOffset> estimate_time_offset(const Trajectory& a, const Trajectory& b,
                                               const TimeOffsetOptions& options = {});

}  // namespace egocal
