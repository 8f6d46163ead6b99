// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/problem/cost.hpp"

namespace egocal {

/// Motion pairs as text, one a line: the dual quaternion of a, then of b (w x y z real, w x y z dual,
/// metres). Throws Error naming file, line and field.
std::vector<MotionPair> read_pairs(const std::string& file);
void write_pairs(const std::string& file, const std::vector<MotionPair>& pairs);

}  // namespace egocal
