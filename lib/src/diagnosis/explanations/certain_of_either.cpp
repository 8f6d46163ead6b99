// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/diagnosis/certain_of_either.hpp"

namespace egocal {

bool certain_of_either(const Finding& finding) {
  return finding.certain || finding.code.starts_with("late_positions_");
}

}  // namespace egocal
