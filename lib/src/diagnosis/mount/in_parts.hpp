// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct PartsOptions {
  /// A mounting that creeps is one mounting in each of as many parts of its way: they leave a quarter of what
  /// one for all leaves. Two mounts that bent by 2 to 4 deg on a tractor in rows were called axes of both
  /// streams, turned by 108 and 126 deg (squares 2.1 and 2.4 times smaller); in four parts they are 2.5
  /// and 3.4 times smaller.
  std::size_t of_creep = 4;
};

/// The parts of the motions between the moves, findings mount_moved in the order of time, and those of what
/// creeps: part k is [bounds[k], bounds[k + 1]). None is empty.
std::vector<std::size_t> bounds_of_parts(const Motions& motions, const std::vector<Finding>& moves,
                                         const PartsOptions& options = {});

/// The motions, each part between the moves with an extrinsic of its own. The fit has squares, and the
/// largest `typical` of the parts; no extrinsic and no weights.
Explained in_parts(const Motions& motions, const std::vector<Finding>& moves,
                   const DiagnosisOptions& options);

}  // namespace egocal::detail
