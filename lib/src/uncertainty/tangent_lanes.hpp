// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Forms of blocks and the steps without them, a block in each lane of a vector. Included once for each
// processor, see problem/square_numbers.hpp. The namespace defines Lanes, lane_count, gather() and
// positive().

using Number = Lanes;

/// Columns of the lower triangle, one after the other.
constexpr int place(int i, int j) {
  return 6 * j - j * (j + 1) / 2 + i;
}

#include "uncertainty/factor_numbers.hpp"

[[gnu::always_inline]] inline void load(const double* from, Lanes& to) {
  __builtin_memcpy(&to, from, sizeof to);
}

[[gnu::always_inline]] inline void keep(const Lanes& value, double* to) {
  __builtin_memcpy(to, &value, sizeof value);
}

/// The sum of four products; a column of numbers times one of lanes.
[[gnu::always_inline]] inline void set_dot(const double* numbers, const Lanes* lanes, Lanes& to) {
  to = numbers[0] * lanes[0] + numbers[1] * lanes[1] + numbers[2] * lanes[2] + numbers[3] * lanes[3];
}

/// As TangentSpace::form() where the first three directions are translations, number by number. rows: of each
/// lane, the 8 x 8 matrix of the block.
inline void set_forms(const TangentNumbers& space, const double* const* rows, double* const curvature,
                      double* const gradient) {
  const double rotation = space.rotation, translation = space.translation;
  Lanes A[4][4], B[4][4], B_transposed[4][4], D[4][4];  // rows
  for (int j = 0; j < 4; ++j) {
    const double *left[lane_count], *upper_right[lane_count], *lower_right[lane_count];
    for (int lane = 0; lane < lane_count; ++lane) {
      left[lane] = rows[lane] + 8 * j;
      upper_right[lane] = left[lane] + 32;
      lower_right[lane] = left[lane] + 36;
    }
    Lanes a[4], b[4], d[4];
    gather(left, a[0], a[1], a[2], a[3]);
    gather(upper_right, b[0], b[1], b[2], b[3]);
    gather(lower_right, d[0], d[1], d[2], d[3]);
    for (int i = 0; i < 4; ++i) {
      A[i][j] = translation * a[i] + rotation * d[i];
      B[i][j] = B_transposed[j][i] = translation * b[i];
      D[i][j] = translation * d[i];
    }
  }
  const auto *U = space.upper, *L = space.lower;
  Lanes upper[7][4],
      lower[7][4];  // S [T, q], by columns; the translations' columns of the upper one are zero
  for (int i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) set_dot(L[c], D[i], lower[c][i]);
    for (int c = 3; c < 7; ++c) {
      Lanes more{};
      set_dot(L[c], D[i], lower[c][i]);
      set_dot(U[c], B_transposed[i], more);
      lower[c][i] += more;
    }
    for (int c = 3; c < 7; ++c) {
      Lanes more{};
      set_dot(L[c], B[i], upper[c][i]);
      set_dot(U[c], A[i], more);
      upper[c][i] += more;
    }
  }
  Lanes norm{}, orthogonal{};
  for (int i = 0; i < 4; ++i) {
    norm += space.norm_of_real[i] * upper[6][i] + space.norm_of_dual[i] * lower[6][i];
    orthogonal += space.orthogonal_of_real[i] * upper[6][i] + space.orthogonal_of_dual[i] * lower[6][i];
  }
  const auto keep_curvature = [&](int i, int j, const Lanes& sum) {
    const Lanes value = sum - norm * space.norm[j][i] + orthogonal * space.orthogonal[j][i];
    keep(value, curvature + 4 * place(i, j));
  };
  // T'ST is symmetric: the rows of the translations are the shorter ones
  Lanes sum{}, more{};
  for (int j = 0; j < 3; ++j)
    for (int i = j; i < 3; ++i) {
      set_dot(L[i], lower[j], sum);
      keep_curvature(i, j, sum);
    }
  for (int c = 3; c < 7; ++c) {
    for (int row = 0; row < 3; ++row) {
      set_dot(L[row], lower[c], sum);
      if (c < 6)
        keep_curvature(c, row, sum);
      else
        keep(sum, gradient + 4 * row);
    }
    for (int row = c < 6 ? c : 3; row < 6; ++row) {
      set_dot(L[row], lower[c], sum);
      set_dot(U[row], upper[c], more);
      sum += more;
      if (c < 6)
        keep_curvature(row, c, sum);
      else
        keep(sum, gradient + 4 * row);
    }
  }
}

/// Newton steps to the minima of the sum without each of the blocks; false where a curvature is not positive
/// definite.
inline bool set_steps_without(const double* sum_curvature, const double* sum_gradient,
                              const double* curvature, const double* gradient, double* steps) {
  Lanes factors[21], x[6];
  EGOCAL_STRAIGHT
  for (int k = 0; k < 21; ++k) {
    load(curvature + 4 * k, factors[k]);
    factors[k] = sum_curvature[k] - factors[k];
  }
  EGOCAL_STRAIGHT
  for (int i = 0; i < 6; ++i) {
    load(gradient + 4 * i, x[i]);
    x[i] = -(sum_gradient[i] - x[i]);
  }
  if (!factorise_leading(factors, 6)) return false;
  solve_leading(factors, x, 6);
  EGOCAL_STRAIGHT
  for (int i = 0; i < 6; ++i) keep(x[i], steps + 4 * i);
  return true;
}

/// products: of each number, six.
inline void set_sums_of_products(const double* curvature, const double* products, double* to) {
  Lanes sums[6]{}, number{};
  EGOCAL_STRAIGHT
  for (int j = 0; j < 6; ++j) EGOCAL_STRAIGHT
  for (int i = 0; i <= j; ++i, products += 6) {
    load(curvature + 4 * place(j, i), number);
    EGOCAL_STRAIGHT
    for (int row = 0; row < 6; ++row) sums[row] += number * products[row];
  }
  for (int row = 0; row < 6; ++row) {
    for (int lane = 0; lane < lane_count; ++lane)
      if (sums[row][lane] < 0) sums[row][lane] = 0;
    keep(sums[row], to + 4 * row);
  }
}
