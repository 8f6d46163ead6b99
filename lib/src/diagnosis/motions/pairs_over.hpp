// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::detail {

/// Motion pairs over `steps` instants, none across a gap, one of which begins at each `each`-th instant.
/// reading: of both streams. origin_us: time of the first pose of a.
std::vector<MotionPair> pairs_over(const Instants& instants, const PoseReading& reading, std::size_t steps,
                                   std::size_t each, std::int64_t origin_us,
                                   const MotionSampleOptions& options);

/// The pairs as seen from the ground planes.
void see_from_planes(const GroundPlane& plane_a, const GroundPlane& plane_b, std::vector<MotionPair>& pairs);

}  // namespace egocal::detail
