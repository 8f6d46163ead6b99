// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Lanes of any processor. Included within a namespace, as problem/square_numbers.hpp is.

using Lanes [[gnu::vector_size(16)]] = double;
constexpr int lane_count = 2;  // numbers in 16 bytes

/// The four numbers of each lane.
[[gnu::always_inline]] inline void gather(const double* const* from, Lanes& w, Lanes& x, Lanes& y, Lanes& z) {
  w = Lanes{from[0][0], from[1][0]};
  x = Lanes{from[0][1], from[1][1]};
  y = Lanes{from[0][2], from[1][2]};
  z = Lanes{from[0][3], from[1][3]};
}
