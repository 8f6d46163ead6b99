// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "offline/rig_calibration.hpp"

namespace egocal::tools {

/// Sets findings and the sensor to blame from what the pairs found, the moves of the mounts and the noise.
/// single_steps: the shortest motions, where the pairs have longer ones; moves are looked for in both. begin:
/// of the first motion, since the first pose of the first sensor [s].
void find_in_rig(std::span<const RigPair> pairs, std::span<const RigPair> single_steps, double begin,
                 RigReport& report);

}  // namespace egocal::tools
