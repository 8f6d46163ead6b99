// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/drives/goal_of_drives.hpp"

namespace egocal::tools {

void count_driving_only(const Drives& drives, Calibration& calibration) {
  if (calibration.goal && calibration.goal->seconds_left)
    *calibration.goal->seconds_left *= drives.driven_part();
}

}  // namespace egocal::tools
