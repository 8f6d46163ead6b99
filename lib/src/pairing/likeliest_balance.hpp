// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "egocal/pairing/selection.hpp"

namespace egocal::detail {

/// For drives in which no answer has a spread: the balance with rotation 1 and one of the translation weights
/// `balances` [1/m^2] that has the most likely answer (estimation/misfit.hpp). Empty: too few motions to
/// choose (SelectionOptions::least_parts).
std::optional<Balance> likeliest_balance(const Problem& problem, const MotionsOfStride& motions,
                                         std::span<const double> balances,
                                         const SelectionOptions& options = {});

}  // namespace egocal::detail
