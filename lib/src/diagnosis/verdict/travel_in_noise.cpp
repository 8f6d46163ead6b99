// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/travel_in_noise.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

double median_travel(const Motions& motions, Side side) {
  std::vector<double> lengths;
  for (const Motion& motion : motions.all)
    lengths.push_back((side == Side::a ? motion.t_a : motion.t_b).norm());
  return median(std::move(lengths));
}

}  // namespace

bool travel_in_noise(const Instants& instants, const Motions& motions, const Pose& T_a_b,
                     const MotionSampleOptions& sample, const TravelInNoiseOptions& options) {
  std::optional<Motions> made;
  if (motions.stride < options.least_stride)
    made = motions_of(instants, {}, {}, options.least_stride, sample.most, sample);
  const Motions& of_longer = made ? *made : motions;
  const Motions of_steps = motions_of(instants, {}, {}, 1, sample.most, sample);
  if (of_longer.all.empty() || of_steps.all.empty()) return false;
  double noise = 0;
  for (const Side side : {Side::a, Side::b}) {
    const double here = median_travel(of_longer, side);
    if (median_travel(of_steps, side) >= options.as_far * here) noise = std::max(noise, here);
  }
  if (!(noise > 0)) return false;
  std::vector<double> rotations, translations;
  for (const Motion& motion : of_longer.all) {
    const Residual residual = residual_at(motion, T_a_b);
    rotations.push_back(residual.rotation);
    translations.push_back(residual.translation);
  }
  return median(std::move(translations)) <= options.most_left * noise &&
         median(std::move(rotations)) <= options.most_of_rotation * of_longer.rotation;
}

}  // namespace egocal::detail
