// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include "egocal/problem/problem.hpp"
#include "egocal/scale/scale_solution.hpp"
#include "egocal/scale/scale_statistics.hpp"
#include "egocal/uncertainty/directions.hpp"

namespace egocal {

/// Which sensor's translations are noisy. Noise in the translations that the scale multiplies pulls it
/// towards zero (errors in variables), noise in the other ones does not.
enum class ScaleNoise {
  both,     ///< both alike: the cost counts lengths in the geometric mean of both units; the pulls cancel
  metric,   ///< only the sensor with the known unit: least squares in metres
  unscaled  ///< only the sensor with the unknown unit: least squares in its unit
};

struct ScaleOptions {
  Side side = Side::a;  ///< whose translations the scale multiplies; the extrinsic is in the other's unit
  double least = 0.01;  ///< scales looked at; four decades hold every camera and odometer met so far
  double most = 100;
  ScaleNoise noise = ScaleNoise::both;
  Mode mode = Mode::spatial;  ///< planar: the motions are those seen from the planes (24)
  /// Rotation against translation; the translation weight holds at the scale found.
  Balance balance{};
  /// The bound may lie this far below the cost, in parts of the weighted translation energy: a scale further
  /// off than about its root is excluded by proof.
  double tolerance = 1e-7;
  /// A limit on time only: 5 to 15 are the rule, a drive that shows no scale may take them all.
  int most_solves = 400;
  /// The scale counts as observable where noise explains at most this part of what shows it. A quarter leaves
  /// a bias below 13 % with noise on both sides.
  double most_noise_share = 0.25;
  /// Bounds at perfect rotations: competitors have an extrinsic no longer than this many lengths that the
  /// drive makes in one radian, and the bound gives away this part of the cost (docs/scale.md).
  double farthest = 1000, given_away = 1e-3;
  /// A scale whose bound lies further below its cost than this part of it is bounded that way as well: ten
  /// times what is given away.
  double weak_bound = 1e-2;
  /// A standard deviation needs at least this many blocks, as ObservabilityOptions::least_blocks.
  std::size_t least_blocks = 6;
  /// Part of the scale by which it may be wrong for reasons that the motions do not show, such as
  /// interpolation; added to the standard deviation.
  double doubt = 0;
};

/// Global minimum over scale and extrinsic by branch and bound over the scale (docs/scale.md has the proof).
/// The blocks are consecutive parts of one drive; the solution depends on their sum, the standard deviation
/// on the parts. Where the rotations are perfect, extrinsics longer than a thousand times what the drive
/// moves per radian do not count as competitors. Never throws; without motion the solution is not certified
/// and not observable.
ScaleSolution solve_scale(std::span<const ScaleStatistics> blocks, const ScaleOptions& options = {});

/// What the scale adds to the standard deviations of an extrinsic that was solved at the scale of the
/// solution [m, rad, frame a]. problem: its mode and plane of a. Both parts are independent where the noise
/// is as the weights say: at a minimum, what the scale can take up is no part of the extrinsic's error at a
/// fixed scale. Where the scale is not known: infinite in each direction that a scale larger by a factor e
/// moves by more than is stated of it, else 0.
std::array<double, 6> spread_by_scale(const Observability& stated, const Problem& problem,
                                      const ScaleSolution& solution);

/// The same added to what is stated. A direction is not observable where the spread is infinite: of a head
/// that turns about one point, each scale explains the motions with a lever arm of its own.
Observability with_spread_of_scale(Observability stated, const Problem& problem,
                                   const ScaleSolution& solution);

}  // namespace egocal
