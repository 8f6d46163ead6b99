// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What a file holds in place of the poses that it should hold.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// Poses of one stream at each instant.
std::vector<Pose> poses_of(const Instants& instants, Side side);

/// The motions of `given` with these poses of one stream at each instant, and the extrinsic that suits them.
Explained with_poses(const Instants& instants, const Explained& given, Side side,
                     const std::vector<Pose>& poses, const DiagnosisOptions& options);

/// Of one stream: angles of the wrong sign, in the wrong place, order or unit; positions in the axes of the
/// sensor; velocities or increments in place of positions. Findings axes_a|_b and missing_a|_b. Looked for
/// where no scale makes the motions agree, so that the answer is wrong in any case.
std::optional<Finding> other_contents(const Evidence& evidence, const DiagnosisOptions& options);

}  // namespace egocal::detail
