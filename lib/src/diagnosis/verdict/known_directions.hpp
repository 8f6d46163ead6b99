// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Motions contradict an answer only in directions that they show.
#pragma once

#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "diagnosis/verdict/judge.hpp"

namespace egocal::detail {

/// The motions contradict only what they show of an answer. Where another extrinsic suits them better, and
/// differs from it in directions that are not known alone, that one counts.
Misfit where_known(const Misfit& misfit, const Motions& motions, const Answered& answered,
                   const DualQuaternion& best, const std::vector<Finding>& findings);

}  // namespace egocal::detail
