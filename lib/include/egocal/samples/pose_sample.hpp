// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
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

/// The rows of two lists of still poses that belong together; poses are never interpolated. Rows whose stamps
/// are each other's nearest, and much nearer than the next sample, belong together; where that leaves rows
/// over and the lists are equally long, row i belongs to row i. Throws Error where neither gives 3 samples.
MatchedSamples match_samples(const Trajectory& a, const Trajectory& b);

/// Whether two recordings look like still poses rather than streams: few poses, as many in both, and large
/// turns between neighbours.
bool look_like_samples(const Trajectory& a, const Trajectory& b);

}  // namespace egocal
