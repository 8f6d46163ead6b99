// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// One still pose of both sensors, in any order among others: the hand of a robot arm in its base (a), and
/// the camera in the frame of the target that it sees (b). Unit dual quaternions.
struct PoseSample {
  DualQuaternion a;  ///< p_world_a = a p_sensor_a
  DualQuaternion b;  ///< p_world_b = b p_sensor_b
};
EGOCAL_SAME_LAYOUT(PoseSample)

/// Samples with the rows they were made of.
struct MatchedSamples {
  std::vector<PoseSample> samples;
  std::vector<std::size_t> rows_a, rows_b;  ///< per sample, counted from 0
  bool by_stamp = true;                     ///< false: row by row
  std::size_t without_partner = 0;          ///< rows of both that are in no sample
};

/// Tuning of match_samples() and look_like_samples(). Study: the sets of docs/samples.md and, for drives of a
/// pose a second, tests/bench/sample_study.cpp.
struct MatchingOptions {
  /// Stamps belong together where they are nearer than this part of the typical distance between samples.
  double nearest_part = 0.25;
  std::size_t most_samples = 200;  ///< recordings with more poses are streams
  /// Still poses turn by more than this from one to the next, streams do not [rad]: 8 degrees.
  double large_turn = 0.13962634015954636;
  /// In a stream neighbours are much more alike than poses far apart; still poses come in any order, or at
  /// best in a scan. Ratio of the turns; drives of a pose a second have a tenth, sets of arms 0.4 and more.
  double unlike_a_stream = 0.3;
};

/// The rows of two lists of still poses that belong together; poses are never interpolated. Rows whose stamps
/// are each other's nearest, and much nearer than the next sample, belong together; where that leaves rows
/// over and the lists are equally long, row i belongs to row i. Throws Error where neither gives 3 samples.
/// Deterministic. Thread-safe.
MatchedSamples match_samples(const Trajectory& a, const Trajectory& b, const MatchingOptions& options = {});

/// Whether two recordings look like still poses rather than streams: few poses, as many in both, and large
/// turns between neighbours.
bool look_like_samples(const Trajectory& a, const Trajectory& b, const MatchingOptions& options = {});

}  // namespace egocal
