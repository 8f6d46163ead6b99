// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace egocal::detail {

/// The value that would be at `place` if the values (no NaN, no negative zero) were sorted: what
/// std::nth_element finds at about a third of its cost, for values in random order mislead the processor at
/// every second branch, and here there are none. room: for twice as many numbers as there are values, which
/// may be the first of it. place < values.size().
inline double selected(std::span<const double> values, std::size_t place, std::span<double> room) {
  constexpr std::size_t few = 8;   // the library's own way is as fast
  constexpr int most_rounds = 40;  // a limit on time: thousands of values take a dozen
  const double* from = values.data();
  std::size_t count = values.size();
  double *less = room.data(), *more = room.data() + values.size();
  for (int round = 0; count > few && round < most_rounds; ++round) {
    const double x = from[count / 8], y = from[count / 2], z = from[count - 1 - count / 8];
    const double pivot = std::max(std::min(x, y), std::min(std::max(x, y), z));
    std::size_t smaller = 0, larger = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double value = from[i];
      less[smaller] = more[larger] = value;
      smaller += static_cast<unsigned>(value < pivot);
      larger += static_cast<unsigned>(value > pivot);
    }
    if (place >= smaller && place < count - larger) return pivot;
    if (place < smaller) {
      from = less;
      count = smaller;
    } else {
      place -= count - larger;
      std::swap(less, more);
      from = less;
      count = larger;
    }
  }
  if (from != less) std::copy_n(from, count, less);
  std::nth_element(less, less + place, less + count);
  return less[place];
}

}  // namespace egocal::detail
