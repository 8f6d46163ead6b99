// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/limits.hpp"

namespace egocal::detail {

/// What CongruenceOptions::angle_floor and length_floor may be [rad, m].
inline constexpr Range angle_floors{1e-15, 1}, length_floors{1e-15, 1e3};

}  // namespace egocal::detail
