// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The motions with other poses of one stream.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// Poses of one stream at each instant.
std::vector<Pose> poses_of(const Instants& instants, Side side);

/// The motions of `given` with these poses of one stream at each instant, and the extrinsic that suits them.
Explained with_poses(const Instants& instants, const Explained& given, Side side,
                     const std::vector<Pose>& poses, const DiagnosisOptions& options);

}  // namespace egocal::detail
