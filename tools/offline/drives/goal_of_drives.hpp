// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/calibrate.hpp"
#include "offline/drives/append.hpp"

namespace egocal::tools {

/// The time until the goal is reached, by the time driven: the hours between drives were taken for driving.
void count_driving_only(const Drives& drives, Calibration& calibration);

}  // namespace egocal::tools
