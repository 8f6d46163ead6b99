// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/options.hpp"

namespace egocal::detail {

/// Finding time_unit: by their stamps the poses come, or the sensors move, faster than any. duration: of one
/// motion; period: of the instants [s]. metres: lengths are; else no speed is impossible.
std::optional<Finding> impossible_pace(const Motions& motions, double duration, double period, bool metres,
                                       const PaceCheckOptions& options);

}  // namespace egocal::detail
