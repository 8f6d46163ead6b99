// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "problem/motion_square.hpp"

#include <cstddef>

#include "problem/wide_lanes.hpp"

namespace egocal::detail {

namespace {

/// Adds eta times the entries.
[[gnu::always_inline]] inline void add_entries(const double* __restrict entries, double eta,
                                               double* __restrict to) {
  for (std::size_t k = 0; k < 64; ++k) to[k] += eta * entries[k];
}

/// Weighs the entries once and adds them to each of the sums.
[[gnu::always_inline]] inline void add_weighted_entries(const double* __restrict entries,
                                                        const SquareWeights& weights,
                                                        std::span<Matrix8d* const> sums) {
  const double all = weights.rotation_only ? 0.0 : weights.translation, rotation = weights.rotation;
  double weighted[64];
  for (std::size_t k = 0; k < 64; ++k) weighted[k] = all * entries[k];
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) weighted[8 * j + i] += rotation * entries[8 * (j + 4) + i + 4];
  for (Matrix8d* sum : sums) {
    double* __restrict const to = sum->data();
    for (std::size_t k = 0; k < 64; ++k) to[k] += weighted[k];
  }
}

#ifdef EGOCAL_WIDE_LANES
[[gnu::target("avx2")]] void add_entries_widely(const double* entries, double eta, double* to) {
  add_entries(entries, eta, to);
}

[[gnu::target("avx2")]] void add_weighted_entries_widely(const double* entries, const SquareWeights& weights,
                                                         std::span<Matrix8d* const> sums) {
  add_weighted_entries(entries, weights, sums);
}
#endif

}  // namespace

void MotionSquare::add_to(Matrix8d& sum, double eta, [[maybe_unused]] bool in_pairs) const {
#ifdef EGOCAL_WIDE_LANES
  if (!in_pairs && has_wide_lanes()) return add_entries_widely(entries_.data(), eta, sum.data());
#endif
  add_entries(entries_.data(), eta, sum.data());
}

void MotionSquare::add_weighted_to(std::span<Matrix8d* const> sums, const SquareWeights& weights,
                                   [[maybe_unused]] bool in_pairs) const {
#ifdef EGOCAL_WIDE_LANES
  if (!in_pairs && has_wide_lanes()) return add_weighted_entries_widely(entries_.data(), weights, sums);
#endif
  add_weighted_entries(entries_.data(), weights, sums);
}

}  // namespace egocal::detail
