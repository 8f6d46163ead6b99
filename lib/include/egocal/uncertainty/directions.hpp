// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "egocal/layout.hpp"

namespace egocal {

/// What is known of each direction x y z roll pitch yaw of sensor a's frame.
struct Observability {
  std::array<bool, 6> observable{};
  std::array<double, 6> stddev{};  ///< [m, rad]; infinite where not observable
  std::string hint;                ///< which motion would help most; empty where nothing is missing
};
EGOCAL_SAME_LAYOUT(Observability)

}  // namespace egocal
