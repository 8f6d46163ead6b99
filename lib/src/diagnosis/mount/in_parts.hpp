// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// The parts of the motions between the moves, findings mount_moved in the order of time: part k is
/// [bounds[k], bounds[k + 1]). None is empty.
std::vector<std::size_t> bounds_of_parts(const Motions& motions, const std::vector<Finding>& moves);

/// The motions, each part between the moves with an extrinsic of its own. The fit has squares, and the
/// largest `typical` of the parts; no extrinsic and no weights.
Explained in_parts(const Motions& motions, const std::vector<Finding>& moves,
                   const DiagnosisOptions& options);

}  // namespace egocal::detail
