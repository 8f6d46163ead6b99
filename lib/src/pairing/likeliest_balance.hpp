// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "egocal/pairing/selection.hpp"

namespace egocal::detail {

/// Where no answer has a spread: the balance of rotation 1 and a translation of `balances` [1/m^2] with the
/// most likely answer by the motions (estimation/misfit.hpp). Empty where they are too few to choose
/// (SelectionOptions::least_parts).
std::optional<Balance> likeliest_balance(const Problem& problem, const MotionsOfStride& motions,
                                         std::span<const double> balances,
                                         const SelectionOptions& options = {});

}  // namespace egocal::detail
