// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "egocal/pairing/options.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/scale/solve_scale.hpp"

namespace egocal {

struct ScaleCourseOptions {
  /// Chance that a scale that never changes is called changing, in one drive. The test is approximate far
  /// out, so it is far below what a user would accept.
  double false_alarms = 1e-5;
  /// Smaller changes are not reported, as a part of the scale: stereo and lidar odometry, whose scale is
  /// known, vary by up to this along a drive (tests/lib/test_scale_course.cpp).
  double least_change = 0.02;
  std::size_t most_blocks = 64;    ///< that a drive is divided into for the search
  std::size_t least_blocks = 12;   ///< fewer say too little about the noise between them
  std::size_t least_block = 8;     ///< motions of one block
  std::size_t most_segments = 16;  ///< a limit on time
  /// Changes of a stretch that are tested together, where fewer show nothing: one of them passes for noise
  /// that wanders while the others are not allowed for. Each more has this part of the chance of a false
  /// alarm, and each must show between its neighbours by itself, with at most this chance.
  std::size_t most_at_once = 4;
  double of_one_more = 0.1;
  double confirmation = 1e-2;
  double least_part = 0.1;  ///< of the stretch, between two such changes
  /// A motion that fits this many times worse than the median one is rejected. Five standard deviations.
  double most_residual = 25;
  double motion = 1;  ///< length of the motions [s]: long enough to be more than noise
  int rounds = 4;     ///< a limit: extrinsic and segments are found alternately
};

/// A part of the drive with a scale of its own, or one that drifts evenly (in its logarithm).
struct ScaleSegment {
  std::int64_t begin_us = 0, end_us = 0;
  double begin_scale = 1, end_scale = 1;  ///< equal except for a drift
  double stddev = 0;                      ///< of the mean scale
};

/// The scale of one stream over a drive.
struct ScaleCourse {
  std::vector<ScaleSegment> segments;  ///< in the order of time, without gaps; one: it does not change
  double at(std::int64_t time_us) const;
  bool changes() const;
};

/// Where the scale of `side` changes: steps (a loop closure or relocalisation of a monocular SLAM) and drift.
/// solution: of the whole drive at one scale. Extrinsic and segments are improved alternately. Throws
/// nothing; where it cannot be tested there is one segment with the scale of the solution.
ScaleCourse find_scale_course(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                              const ScaleSolution& solution, Side side,
                              const ScaleCourseOptions& options = {});

/// The same from motions of the drive, in the order of time; in planar mode as seen from the planes, that of
/// the scaled sensor through its origin. A long drive needs not all of its motions: a change is placed
/// between two of them.
ScaleCourse find_scale_course(std::span<const MotionPair> pairs, Mode mode, const ScaleSolution& solution,
                              Side side, const ScaleCourseOptions& options = {});

/// The trajectory with the translation of each step multiplied by the scale at its time.
Trajectory scaled(const Trajectory& trajectory, const ScaleCourse& course);

}  // namespace egocal
