// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/lengths/spread_motions.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/motions/pairs_over.hpp"
#include "egocal/problem/problem.hpp"
#include "egocal/scale/estimate_scale.hpp"
#include "scale/kept_motions.hpp"

namespace egocal::detail {

bool is_long(const Instants& instants, const LongDriveOptions& options) {
  return instants.size() > options.most;
}

std::vector<MotionPair> spread_motions(const Instants& instants, std::int64_t origin_us,
                                       const PairingOptions& pairing, const MotionSampleOptions& motions,
                                       const LongDriveOptions& options) {
  constexpr double most_steps = 64;  // as where all motions are looked at
  const auto steps = static_cast<std::size_t>(
      std::clamp(std::round(options.motion / std::max(instants.period, 1e-6)), 1.0, most_steps));
  const std::size_t each = (instants.size() + options.most - 1) / options.most;
  std::vector<MotionPair> pairs =
      pairs_over(instants, {}, steps, std::max<std::size_t>(1, each), origin_us, motions);
  if (pairing.mode != Mode::planar) return pairs;
  GroundPlane through_b = pairing.plane_b;
  through_b.distance = 0;  // the height of the scaled sensor is not to be scaled
  see_from_planes(pairing.plane_a, through_b, pairs);
  return pairs;
}

std::optional<ScaleSolution> scale_of_b(std::span<const MotionPair> motions, Mode mode) {
  if (motions.empty()) return std::nullopt;
  DriveScaleOptions options;
  options.scale.side = Side::b;
  options.scale.mode = mode;
  options.scale.balance = even_balance(scale_blocks(motions), Side::b);
  ScaleSolution solution = estimate_scale(motions, options);
  if (const std::optional<Balance> better = noise_balance(motions, solution, Side::b)) {
    options.scale.balance = *better;
    solution = estimate_scale(motions, options);
  }
  return solution;
}

}  // namespace egocal::detail
