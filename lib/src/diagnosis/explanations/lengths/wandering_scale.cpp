// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/lengths/wandering_scale.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/microseconds.hpp"

namespace egocal::detail {

namespace {

/// Numbers of the motions at which parts begin: those between the moves, halved until there are `least`.
std::vector<std::size_t> begins_of_parts(const Motions& motions, const std::vector<Finding>& moves,
                                         std::size_t least) {
  const std::size_t n = motions.all.size();
  std::vector<std::size_t> begins{0};
  for (const Finding& move : moves) {
    if (!move.time) continue;
    const auto later = std::find_if(motions.all.begin(), motions.all.end(),
                                    [&](const Motion& motion) { return motion.time > *move.time; });
    const auto begin = static_cast<std::size_t>(later - motions.all.begin());
    if (begin > begins.back() && begin < n) begins.push_back(begin);
  }
  begins.push_back(n);
  while (begins.size() - 1 < least && n > 2 * least) {
    std::vector<std::size_t> finer{0};
    for (std::size_t i = 1; i < begins.size(); ++i) {
      const std::size_t middle = (begins[i - 1] + begins[i]) / 2;
      if (middle > finer.back()) finer.push_back(middle);
      if (begins[i] > finer.back()) finer.push_back(begins[i]);
    }
    begins = std::move(finer);
  }
  return begins;
}

/// The factor of b's lengths that suits motions [first, last) best.
double scale_of(const Motions& motions, const RobustFit& fit, std::size_t first, std::size_t last) {
  const Pose T = to_pose(fit.T);
  double product = 0, square = 0;
  for (std::size_t i = first; i < last; ++i) {
    const Motion& motion = motions.all[i];
    const Eigen::Vector3d of_a = motion.R_a * T.translation + motion.t_a - T.translation;
    product += fit.weights[i] * of_a.dot(T.rotation * motion.t_b);
    square += fit.weights[i] * motion.t_b.squaredNorm();
  }
  return square > 0 && product > 0 ? product / square : 1;
}

}  // namespace

std::optional<ScaleCourse> wandering_scale(const Motions& motions, std::int64_t origin_us,
                                           const std::vector<Finding>& moves,
                                           const DiagnosisOptions& options) {
  const WanderingScaleOptions& tuning = options.wandering_scale;
  const std::vector<std::size_t> begins = begins_of_parts(motions, moves, tuning.parts);
  Motions followed = motions;
  RobustFit fit = robust_fit(motions, options.fit);
  std::vector<double> scales(begins.size() - 1, 1.0);
  for (int round = 0; round < tuning.rounds; ++round) {
    for (std::size_t part = 0; part < scales.size(); ++part) {
      scales[part] *= scale_of(followed, fit, begins[part], begins[part + 1]);
      for (std::size_t i = begins[part]; i < begins[part + 1]; ++i) {
        followed.all[i].t_b = motions.all[i].t_b * scales[part];
        followed.all[i].b.dual = motions.all[i].b.dual * scales[part];
      }
    }
    fit = robust_fit(followed, options.fit);
  }
  const auto [smallest, largest] = std::minmax_element(scales.begin(), scales.end());
  if (!(std::log(*largest / *smallest) < tuning.most)) return std::nullopt;
  ScaleCourse course;
  for (std::size_t part = 0; part < scales.size(); ++part) {
    const auto time_us = [&](std::size_t i) {
      return origin_us + to_microseconds(motions.all[std::min(i, motions.all.size() - 1)].time);
    };
    course.segments.push_back({time_us(begins[part]), time_us(begins[part + 1]), scales[part], scales[part]});
  }
  return course;
}

}  // namespace egocal::detail
