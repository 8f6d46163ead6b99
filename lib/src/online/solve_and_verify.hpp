// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "egocal/online/answer.hpp"

namespace egocal::detail {

/// solve() without observability and standard deviations. Q: cost matrix of the problem (16).
Answer solve_and_verify(const Problem& problem, const Matrix8d& Q, Method method,
                        const std::optional<DualQuaternion>& start = std::nullopt,
                        NanosecondClock clock = nullptr);

}  // namespace egocal::detail
