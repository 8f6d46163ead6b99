// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "egocal/scale/scale_course.hpp"

namespace egocal::detail {

/// At a known extrinsic the cost of one motion is square s^2 - 2 product s + rest: what it shows of the scale
/// alone.
struct ScaleSample {
  double square = 0, product = 0, rest = 0;
  std::int64_t begin_us = 0, end_us = 0;
};
ScaleSample scale_sample(const MotionPair& pair, const DualQuaternion& q, Side side);

/// Segments of consecutive samples, with scales of the samples' own estimate. One where nothing changes.
/// whole_only: several changes are tested together in the whole drive alone, not in a part of it. For an
/// extrinsic found at one scale: if that is wrong, the parts' own scales seem to vary with the motion.
std::vector<ScaleSegment> scale_segments(std::span<const ScaleSample> samples,
                                         const ScaleCourseOptions& options, bool whole_only);

}  // namespace egocal::detail
