// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "egocal/moves/find_moves.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal {

namespace {

/// Length of three components: of the significant ones, or of all.
double length_of(const Move& move, std::size_t first, double least_sigmas) {
  double sum = 0;
  for (std::size_t i = first; i < first + 3; ++i)
    if (std::abs(move.change[i]) > least_sigmas * move.stddev[i]) sum += move.change[i] * move.change[i];
  return std::sqrt(sum);
}

/// Standard deviation of three components of two changes together.
double stddev_of(const Move& x, const Move& y, std::size_t first) {
  double variance = 0;
  for (std::size_t i = first; i < first + 3; ++i)
    variance += x.stddev[i] * x.stddev[i] + y.stddev[i] * y.stddev[i];
  return std::sqrt(variance);
}

}  // namespace

ShownChange shown_change(const Move& move) {
  constexpr double sigmas = 3;  // of six components two of theirs are exceeded by chance now and then
  ShownChange shown{length_of(move, 3, sigmas), length_of(move, 0, sigmas)};
  if (shown.turn == 0 && shown.shift == 0)
    shown.turn = length_of(move, 3, 0);  // about an axis across the frame's
  return shown;
}

bool falls_back(const Move& moved, const Move& back) {
  if (moved.kind != MoveKind::bump || back.kind != MoveKind::bump) return false;
  constexpr double sigmas = 3;  // as of what is shown
  const detail::Vector6d left = detail::frame_a_difference(moved.before, back.after);
  return left.tail<3>().norm() <= sigmas * stddev_of(moved, back, 3) &&
         left.head<3>().norm() <= sigmas * stddev_of(moved, back, 0);
}

}  // namespace egocal
