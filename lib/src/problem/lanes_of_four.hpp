// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Lanes of a processor with AVX2 (problem/wide_lanes.hpp). Included within a namespace, where functions are
// compiled for it, as problem/square_numbers.hpp is.

using Lanes [[gnu::vector_size(32)]] = double;
constexpr int lane_count = 4;  // numbers in 32 bytes

/// The four numbers of each lane.
[[gnu::always_inline]] inline void gather(const double* const* from, Lanes& w, Lanes& x, Lanes& y, Lanes& z) {
  const __m256d row_0 = _mm256_loadu_pd(from[0]), row_1 = _mm256_loadu_pd(from[1]),
                row_2 = _mm256_loadu_pd(from[2]), row_3 = _mm256_loadu_pd(from[3]);
  const __m256d low_01 = _mm256_unpacklo_pd(row_0, row_1), high_01 = _mm256_unpackhi_pd(row_0, row_1),
                low_23 = _mm256_unpacklo_pd(row_2, row_3), high_23 = _mm256_unpackhi_pd(row_2, row_3);
  w = _mm256_permute2f128_pd(low_01, low_23, 0x20);
  x = _mm256_permute2f128_pd(high_01, high_23, 0x20);
  y = _mm256_permute2f128_pd(low_01, low_23, 0x31);
  z = _mm256_permute2f128_pd(high_01, high_23, 0x31);
}
