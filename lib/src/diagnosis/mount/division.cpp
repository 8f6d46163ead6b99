// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/division.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace egocal::detail {

namespace {

/// Floor of the squares, as a part of the typical one: smaller squares count as the floor, as in compare().
constexpr double part_of_typical = 0.25;

Division divided(const Motions& motions, std::size_t at, const RobustFitOptions& options) {
  return {at, quick_fit(part_of(motions, 0, at), options),
          quick_fit(part_of(motions, at, motions.all.size()), options)};
}

/// Sum of the logarithms of the squares: outliers do not decide it.
double misfit_of(const std::vector<double>& squares, double floor) {
  double sum = 0;
  for (const double square : squares) sum += std::log(square + floor);
  return sum;
}

}  // namespace

std::size_t best_place(const Motions& motions, const Division& division, std::size_t margin, double floor) {
  const RobustFit before = evaluated(motions, division.before.T),
                  after = evaluated(motions, division.after.T);
  const std::size_t n = motions.all.size();
  double sum = 0, least = 0;
  std::size_t place = margin;
  for (std::size_t i = 0; i + margin <= n; ++i) {
    if (i >= margin && (i == margin || sum < least)) {
      least = sum;
      place = i;
    }
    if (i < n) sum += std::log(before.squares[i] + floor) - std::log(after.squares[i] + floor);
  }
  return place;
}

std::optional<Division> best_division(const Motions& motions, const RobustFit& whole, std::size_t margin,
                                      std::size_t places, const RobustFitOptions& options) {
  const std::size_t n = motions.all.size();
  if (n < 2 * margin || margin == 0) return std::nullopt;
  const double floor = part_of_typical * whole.typical;
  Division best;
  double least = misfit_of(whole.squares, floor);
  for (std::size_t i = 1; i <= places; ++i) {
    const std::size_t at = i * n / (places + 1);
    if (at < margin || n - at < margin) continue;
    Division here = divided(motions, at, options);
    const double value = misfit_of(here.before.squares, floor) + misfit_of(here.after.squares, floor);
    if (value < least) {
      least = value;
      best = std::move(here);
    }
  }
  if (best.at == 0) return std::nullopt;
  best.at =
      best_place(motions, best, margin, part_of_typical * std::min(best.before.typical, best.after.typical));
  best.before = robust_fit(part_of(motions, 0, best.at), options);
  best.after = robust_fit(part_of(motions, best.at, n), options);
  return best;
}

Explained in_two(const Motions& motions, const Division& division) {
  Explained two{motions, {}};
  two.fit.squares = division.before.squares;
  two.fit.squares.insert(two.fit.squares.end(), division.after.squares.begin(), division.after.squares.end());
  two.fit.typical = std::max(division.before.typical, division.after.typical);
  return two;
}

}  // namespace egocal::detail
