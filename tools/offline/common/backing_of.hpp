// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "egocal/calibrate.hpp"
#include "egocal/io/extrinsic_text.hpp"

namespace egocal::tools {

/// What the numbers of x y z roll pitch yaw rest on.
std::array<Backing, 6> backing_of(const Calibration& calibration);

/// "NOT OBSERVABLE, not a measurement: z": what the motions do not show of T_a_b. Empty where they show all.
std::string not_shown_in_words(const Calibration& calibration);

}  // namespace egocal::tools
