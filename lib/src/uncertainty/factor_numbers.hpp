// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// L D L' of one 6 x 6 matrix, or of several in the lanes of a vector: the same operations, hence the same
// bits. Included once for each kind of Number, within a namespace that defines it, positive() and place(),
// where the number of row i and column j <= i is; see problem/square_numbers.hpp.

/// Factorises in place: L below the diagonal, the inverse of D on it. False where a pivot is not positive.
[[gnu::always_inline]] inline bool factorise_leading(Number* const a, const int n) {
  EGOCAL_STRAIGHT
  for (int j = 0; j < n; ++j) {
    const Number pivot = a[place(j, j)];
    if (!positive(pivot)) return false;
    const Number inverse = 1 / pivot;
    EGOCAL_STRAIGHT
    for (int k = j + 1; k < n; ++k) {
      const Number scaled = a[place(k, j)] * inverse;
      EGOCAL_STRAIGHT
      for (int i = k; i < n; ++i) a[place(i, k)] -= a[place(i, j)] * scaled;
      a[place(k, j)] = scaled;
    }
    a[place(j, j)] = inverse;
  }
  return true;
}

[[gnu::always_inline]] inline void solve_leading(const Number* const a, Number* const x, const int n) {
  EGOCAL_STRAIGHT
  for (int j = 0; j < n; ++j) {
    EGOCAL_STRAIGHT
    for (int i = j + 1; i < n; ++i) x[i] -= a[place(i, j)] * x[j];
  }
  EGOCAL_STRAIGHT
  for (int j = n - 1; j >= 0; --j) {
    x[j] *= a[place(j, j)];
    EGOCAL_STRAIGHT
    for (int i = j + 1; i < n; ++i) x[j] -= a[place(i, j)] * x[i];
  }
}
