// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What a file holds in place of the poses that it should hold.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

struct OtherContentsOptions {
  /// Contents of either stream that are fitted to all motions after the first look, the most promising first:
  /// a compass heading and a yaw of the wrong sign of both streams look alike.
  std::size_t followed = 4;
};

/// What one stream may hold in place of its poses: angles of the wrong sign, in the wrong place, order or
/// unit; positions in the axes of the sensor; velocities or increments in place of positions; steps that were
/// turned by the attitude of another instant (other_contents_steps.hpp); steps the wrong way round
/// (reversed_steps.hpp); positions of the row before or after (late_by_a_row.hpp). Findings axes_a|_b,
/// missing_a|_b and late_positions_a|_b, the best one first, with those that fit nearly as well. Velocities
/// are looked for where no scale makes the motions agree.
std::vector<Finding> other_contents(const Evidence& evidence, const DiagnosisOptions& options,
                                    const OtherContentsOptions& contents = {});

}  // namespace egocal::detail
