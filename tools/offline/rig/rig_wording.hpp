// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "offline/rig/calibration.hpp"

namespace egocal::tools {

/// How a rig's sensors were given, for cures that name an option or a key.
struct RigWords {
  std::string rig;                  ///< file; empty: there is none
  bool offset_found = false;        ///< --time-offset auto was given
  std::string name_a, name_b;       ///< of the pair
  double scale_a = 1, scale_b = 1;  ///< that their lengths were multiplied by
  bool listed_turned = false;       ///< the rig file lists b, a: its nominal value is the pose of a in b
  double time_offset = 0;           ///< that was added to the stamps of b, against a [s]
};

/// What a pair found in the words of a rig: number and sign of the sensor that is named (`of_b`: of the two
/// it is b; empty: of none), sensors by their names, and a cure that works for rigs.
void word_for_rig(const Finding& found, std::optional<bool> of_b, const RigWords& words, RigFinding& finding);

}  // namespace egocal::tools
