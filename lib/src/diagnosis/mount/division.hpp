// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A drive in two parts with an answer each.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"

namespace egocal::detail {

/// Two answers, before motion number `at` and from it on.
struct Division {
  std::size_t at = 0;
  RobustFit before, after;
};

/// Number of the motion where two known answers meet best: at least `margin` motions are on either side.
/// floor: of noise, added to the squares.
std::size_t best_place(const Motions& motions, const Division& division, std::size_t margin, double floor);

/// The best of `places` divisions that are tried evenly, then of every motion, with robust answers. Outliers
/// do not decide: the logarithms of the squares are summed. Empty where none fits better than one answer does
/// (`whole`, of the same motions).
std::optional<Division> best_division(const Motions& motions, const RobustFit& whole, std::size_t margin,
                                      std::size_t places, const RobustFitOptions& options);

/// The motions with the two answers: squares and the larger `typical`; no extrinsic and no weights.
Explained in_two(const Motions& motions, const Division& division);

}  // namespace egocal::detail
