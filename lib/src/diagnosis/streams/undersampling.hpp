// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whether the interpolation of one stream at the stamps of the other one changes the answer.
#pragma once

#include <array>
#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/diagnosis/options.hpp"

namespace egocal::detail {

/// How far the answer may be off in each direction (x y z roll pitch yaw in sensor a's frame [m, rad])
/// because one stream is interpolated: the change of an answer where it is interpolated through more poses,
/// which keeps more of fast motions, less what that changes by chance (docs/method.md, "Interpolation"). Zero
/// where no pose is interpolated, or nothing can be said.
std::array<double, 6> interpolation_stddev(const Instants& instants, const DualQuaternion& T_a_b,
                                           const DiagnosisOptions& options);

/// Finding undersampled_a or undersampled_b, where that is more than the answer states to be uncertain.
std::optional<Finding> undersampled(const Instants& instants, const Answered& answered,
                                    const std::array<double, 6>& interpolation_stddev,
                                    const UndersamplingOptions& options);

}  // namespace egocal::detail
