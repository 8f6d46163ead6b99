// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "egocal/robust/prove_outliers.hpp"

namespace egocal::detail {

struct ChoiceSearch {
  bool complete = false;  ///< every choice was excluded, or has a lower bound of at least the given cost
  std::size_t solves = 0;
  std::optional<std::vector<bool>> better;  ///< outliers of a choice that is cheaper
};

/// Branch and bound over the undecided parts; the others keep their sides. `cost`: of the choice given.
ChoiceSearch search_choices(std::span<const TruncatedPart> parts, const std::vector<bool>& outlier,
                            const std::vector<std::size_t>& undecided, double cost,
                            const OutlierProofOptions& options);

}  // namespace egocal::detail
