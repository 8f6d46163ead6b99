// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/scale/estimate_scale.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/scale/interpolation_loss.hpp"
#include "egocal/statistics/median.hpp"
#include "pairing/single_stride_choice.hpp"
#include "scale/kept_motions.hpp"
#include "scale/unjudged_motions.hpp"

namespace egocal {

namespace {

/// What interpolation leaves in the lengths of one stream, as a part of them: it adds to the standard
/// deviation.
double interpolation_doubt(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing) {
  const PairingResult steps = pair_motions(detail::unjudged(pairing, 1), a, b);
  InterpolationLossOptions options;
  options.cut_alike = pairing.synchroniser.cut_alike;
  options.most_stamps = std::max(a.size(), b.size());
  InterpolationLoss loss(options);
  for (const StampedPose& pose : a) loss.stamp(Side::a, pose.time_us);
  const std::int64_t offset_us = to_microseconds(pairing.time_offset);
  for (const StampedPose& pose : b) loss.stamp(Side::b, pose.time_us + offset_us);
  const Side keys = steps.drive.state().synchroniser.keys.value_or(Side::b);
  for (const MotionPair& step : steps.pairs) loss.step(step, keys);
  return loss.part();
}

}  // namespace

ScaleSolution estimate_scale(std::span<const MotionPair> given, const DriveScaleOptions& options) {
  std::vector<MotionPair> kept = detail::of_plausible_length(given);
  ScaleSolution solution;
  for (int pass = 0; pass < 6; ++pass) {
    solution = solve_scale(scale_blocks(kept), options.scale);
    std::vector<double> residuals;
    for (const MotionPair& pair : given)
      residuals.push_back(detail::scale_residual(pair, solution, options.scale.side));
    const double limit = options.most_residual * detail::median(residuals);
    if (!(limit > 0) || !std::isfinite(limit)) break;
    std::vector<MotionPair> again;
    for (std::size_t i = 0; i < given.size(); ++i)
      if (residuals[i] <= limit) again.push_back(given[i]);
    const bool same = again.size() == kept.size();
    kept = std::move(again);
    if (same && pass > 0) break;
  }
  return solution;
}

std::optional<ScaleSolution> estimate_scale(const Trajectory& a, const Trajectory& b,
                                            const PairingOptions& given,
                                            const DriveScaleOptions& given_options) {
  DriveScaleOptions options = given_options;
  const Side side = options.scale.side;
  PairingOptions pairing = given;
  pairing.track_time_offset = false;
  options.scale.mode = pairing.mode;
  // the height of the scaled sensor's plane is not to be scaled
  (side == Side::a ? pairing.plane_a : pairing.plane_b).distance = 0;

  const std::vector<MotionPair> first = detail::unjudged_motions(a, b, pairing, options.first_motion);
  if (first.empty()) return std::nullopt;
  options.scale.balance = detail::even_balance(scale_blocks(first), side);
  options.scale.doubt = interpolation_doubt(a, b, pairing);
  ScaleSolution solution = estimate_scale(first, options);
  double applied = solution.scale;
  for (int round = 0; round < options.rounds; ++round) {
    const Trajectory scaled_a = side == Side::a ? scaled(a, applied) : a;
    const Trajectory scaled_b = side == Side::b ? scaled(b, applied) : b;
    PairingOptions fixed = pairing;
    if (!pairing.stride || !pairing.balance) {
      const Choice choice = detail::single_stride_choice(pairing, scaled_a, scaled_b);
      fixed.stride = choice.stride;
      fixed.balance = choice.balance;
    }
    const PairingResult paired = pair_motions(fixed, scaled_a, scaled_b);
    if (paired.pairs.size() < 2) break;
    DriveScaleOptions relative = options;
    relative.scale.balance = *fixed.balance;
    relative.scale.least = options.scale.least / applied;
    relative.scale.most = options.scale.most / applied;
    solution = estimate_scale(paired.pairs, relative);
    const double factor = solution.scale;
    solution.scale *= applied;
    solution.least_scale *= applied;
    solution.most_scale *= applied;
    solution.stddev *= applied;
    if (!solution.observable) break;
    applied = solution.scale;
    if (std::abs(factor - 1) < 1e-3 * solution.stddev / solution.scale || std::abs(factor - 1) < 1e-9) break;
  }
  return solution;
}

}  // namespace egocal
