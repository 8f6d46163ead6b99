// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/problem/cost.hpp"

namespace egocal::bench {

/// (22) by CSDP's callable library with its default parameters, from building its problem to the multipliers.
Multipliers csdp(const Matrix8d& Q);

}  // namespace egocal::bench
