// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace egocal {

/// Names of the directions of an extrinsic, in the order of all arrays of six: observability, standard
/// deviations.
inline constexpr const char* direction_names[] = {"x", "y", "z", "roll", "pitch", "yaw"};

}  // namespace egocal
