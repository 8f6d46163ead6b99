// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// With how many digits the poses of a stream were written. A file does not say so, and reading makes its
// quaternions unit ones; but all of its numbers are multiples of one step.
#pragma once

#include <cstddef>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

struct WrittenDigitsOptions {
  std::size_t looked_at = 200;  ///< poses of a stream whose digits are counted, at most
  std::size_t fewest = 20;      ///< poses
  double most_others = 0.01;    ///< part of the poses that may have more digits: integers by chance, zeros
  int most_digits = 8;          ///< of those that are counted: what is left of more is that of doubles
};

/// How numbers were written: so many decimals, or so many significant digits. What holds of both is coarser.
struct Digits {
  int decimals = 0, significant = 0;  ///< 0: of no number that is counted

  bool known() const { return decimals > 0 || significant > 0; }
  /// Distance from one such number of about this size to the next; 0 where the digits are not known.
  double step(double size) const;
};

struct Written {
  Digits position, rotation;
};

/// Digits of positions and rotations; unknown where the poses have more digits, or are few.
Written written(const Trajectory& trajectory, const WrittenDigitsOptions& options = {});

/// Decimals of the rotation matrices that the quaternions were made from; unknown where they are of no such
/// matrices, have more decimals, or are few.
Digits digits_of_matrices(const Trajectory& trajectory, const WrittenDigitsOptions& options = {});

}  // namespace egocal::detail
