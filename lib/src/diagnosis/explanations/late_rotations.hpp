// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

/// Where rotations alone are late, the clock that suits them is wrong for the positions: late_positions_a or
/// _b is added after a certain clock_offset, and both have the answer that suits both. Nothing is added
/// beside other certain findings. max_gap: of interpolation [s].
void name_late_rotations(const Evidence& evidence, double max_gap, const DiagnosisOptions& options,
                         std::vector<Finding>& findings);

}  // namespace egocal::detail
