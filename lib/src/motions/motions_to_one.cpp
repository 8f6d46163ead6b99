// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "motions/motions_to_one.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "problem/wide_lanes.hpp"

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace egocal::detail {

namespace {

/// Where the numbers are and go to: real and dual part of a, then of b.
struct PosesOfMotions {
  const double* from[4][MotionsToOne::count];
  const double* to[4];
  double* squares[MotionsToOne::count];
};

/// Which of a square's 36 numbers each of the 64 entries of its matrix is.
constexpr std::array<std::uint8_t, 64> places_of_entries() {
  std::array<std::uint8_t, 64> result{};
  for (std::size_t k = 0; k < square_places.size(); ++k) {
    const auto i = static_cast<std::size_t>(square_places[k][0]),
               j = static_cast<std::size_t>(square_places[k][1]);
    result[8 * j + i] = result[8 * i + j] = static_cast<std::uint8_t>(k);
  }
  return result;
}
constexpr std::array<std::uint8_t, 64> places = places_of_entries();
constexpr const std::uint8_t* number_at = places.data();

/// Lanes of two numbers, for any processor.
namespace narrow {

#include "problem/lanes_of_two.hpp"

[[gnu::always_inline]] inline Lanes root(const Lanes& x) {
#ifdef __SSE2__
  return _mm_sqrt_pd(x);
#else
  return Lanes{std::sqrt(x[0]), std::sqrt(x[1])};
#endif
}

/// Number k of each lane's row to its place `at` + k.
[[gnu::always_inline]] inline void store(const Lanes* const* rows, double* const* to, int at) {
  for (int lane = 0; lane < lane_count; ++lane)
    for (int k = 0; k < lane_count; ++k) to[lane][at + k] = (*rows[k])[lane];
}

#include "motions/motions_to_one_lanes.hpp"

}  // namespace narrow

#ifdef EGOCAL_WIDE_LANES
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

namespace wide {

#include "problem/lanes_of_four.hpp"

[[gnu::always_inline]] inline Lanes root(const Lanes& x) {
  return _mm256_sqrt_pd(x);
}

[[gnu::always_inline]] inline void store(const Lanes* const* rows, double* const* to, int at) {
  const __m256d low_01 = _mm256_unpacklo_pd(*rows[0], *rows[1]),
                high_01 = _mm256_unpackhi_pd(*rows[0], *rows[1]),
                low_23 = _mm256_unpacklo_pd(*rows[2], *rows[3]),
                high_23 = _mm256_unpackhi_pd(*rows[2], *rows[3]);
  _mm256_storeu_pd(to[0] + at, _mm256_permute2f128_pd(low_01, low_23, 0x20));
  _mm256_storeu_pd(to[1] + at, _mm256_permute2f128_pd(high_01, high_23, 0x20));
  _mm256_storeu_pd(to[2] + at, _mm256_permute2f128_pd(low_01, low_23, 0x31));
  _mm256_storeu_pd(to[3] + at, _mm256_permute2f128_pd(high_01, high_23, 0x31));
}

#include "motions/motions_to_one_lanes.hpp"

}  // namespace wide

#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

}  // namespace

void set_motions_to_one(const std::array<const Instant*, MotionsToOne::count>& from, const Instant& to,
                        MotionsToOne& result, [[maybe_unused]] bool in_pairs) {
  PosesOfMotions poses;
  const auto numbers_of = [](const Instant& instant, int part) {
    const DualQuaternion& pose = part < 2 ? instant.a : instant.b;
    return (part % 2 == 0 ? pose.real : pose.dual).data();
  };
  for (int part = 0; part < 4; ++part) {
    for (std::size_t i = 0; i < from.size(); ++i) poses.from[part][i] = numbers_of(*from[i], part);
    poses.to[part] = numbers_of(to, part);
  }
  for (std::size_t i = 0; i < from.size(); ++i) poses.squares[i] = result.squares[i].entries();
#ifdef EGOCAL_WIDE_LANES
  if (has_wide_lanes() && !in_pairs) return wide::motions_to_one(poses, 0, result);
#endif
  for (int first = 0; first < MotionsToOne::count; first += narrow::lane_count)
    narrow::motions_to_one(poses, first, result);
}

}  // namespace egocal::detail
