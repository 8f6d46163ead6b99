// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/likeliest_balance.hpp"

#include <limits>

#include "estimation/misfit.hpp"
#include "solvers/minimiser.hpp"

namespace egocal {

std::optional<Balance> detail::likeliest_balance(const Problem& problem, const MotionsOfStride& motions,
                                                 std::span<const double> balances,
                                                 const SelectionOptions& options) {
  const std::uint64_t two_motions = 2 * static_cast<std::uint64_t>(motions.stride);
  if (merge_blocks(motions.blocks, two_motions).size() < options.least_parts) return std::nullopt;
  const Statistics sum = sum_blocks(motions.blocks);
  std::optional<Balance> likeliest;
  double least = std::numeric_limits<double>::infinity();
  for (const double translation : balances) {
    const Balance balance{1, translation};
    const double here = misfit(sum, minimiser(cost_matrix(sum, balance), problem.mode),
                               options.least_rotation, options.least_translation);
    if (!(here < least)) continue;
    least = here;
    likeliest = balance;
  }
  return likeliest;
}

}  // namespace egocal
