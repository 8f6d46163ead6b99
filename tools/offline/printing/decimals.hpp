// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace egocal::tools {

/// Values that are printed with so many decimals, none of them as "-0.00000".
Eigen::Vector3d without_negative_zeros(Eigen::Vector3d values, int decimals);

}  // namespace egocal::tools
