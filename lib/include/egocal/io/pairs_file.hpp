// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/problem/cost.hpp"

namespace egocal {

/// Motion pairs as text, one a line: the dual quaternion of a, then of b (w x y z real, w x y z dual,
/// metres), normalised. The file has no times and weights: those of the pairs are 0 and 1. Throws Error
/// naming file, line and field where a row is not two rigid motions, or naming the file where it cannot be
/// read.
std::vector<MotionPair> read_pairs(const std::string& file);
/// The file appears whole or not at all. Throws Error naming it where it cannot be written.
void write_pairs(const std::string& file, const std::vector<MotionPair>& pairs);

}  // namespace egocal
