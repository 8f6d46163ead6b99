// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/diagnosis/verdict.hpp"

namespace egocal {

/// Something is wrong for certain, although it may be open with which stream: late positions of either of two
/// streams are uncertain each, but one of the two has them.
bool certain_of_either(const Finding& finding);

}  // namespace egocal
