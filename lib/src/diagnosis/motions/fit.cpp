// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "statistics/quantile.hpp"

namespace egocal::detail {

namespace {

double median_if_any(const std::vector<double>& values) {
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : quantile(values, 0.5);
}

/// Ratio of b's size to a's: the median, weighted by what both streams moved. The weight of a motion is the
/// smaller of its two sizes, each in units of the usual size of its own stream, so that jumps of one stream
/// do not matter, however long.
double median_ratio(const std::vector<Motion>& motions, double (*size_a)(const Motion&),
                    double (*size_b)(const Motion&)) {
  std::vector<double> a, b;
  for (const Motion& motion : motions)
    if (size_a(motion) > 0 && size_b(motion) > 0) {
      a.push_back(size_a(motion));
      b.push_back(size_b(motion));
    }
  if (a.empty()) return 1;
  const double usual_a = quantile(a, 0.5), usual_b = quantile(b, 0.5);
  std::vector<std::pair<double, double>> ratios;
  for (std::size_t i = 0; i < a.size(); ++i)
    ratios.emplace_back(b[i] / a[i], std::min(a[i] / usual_a, b[i] / usual_b));
  return weighted_median(std::move(ratios));
}

struct Residuals {
  std::vector<double> rotation, translation, relative;

  void add(const Motion& motion, const Pose& T, bool rests) {
    const Residual residual = residual_at(motion, T);
    rotation.push_back(residual.rotation);
    translation.push_back(residual.translation);
    const double length = 0.5 * (motion.t_a.norm() + motion.t_b.norm());
    // at rest there is nothing to compare with
    if (!rests && length > 1e-9) relative.push_back(residual.translation / length);
  }
};

}  // namespace

Fit fit_at(const Motions& motions, const Pose& T_a_b, double motion_seconds,
           const MotionSampleOptions& options) {
  Fit fit;
  fit.motion_seconds = motion_seconds;
  if (motions.all.empty()) return fit;
  const std::size_t parts = std::max<std::size_t>(1, options.time_parts);
  const double begin = motions.all.front().time, end = motions.all.back().time;
  const double width = (end - begin) / static_cast<double>(parts);
  const std::vector<bool> rest = at_rest(motions, T_a_b);
  Residuals whole;
  std::vector<Residuals> tenths(parts);
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    const Motion& motion = motions.all[i];
    whole.add(motion, T_a_b, rest[i]);
    const auto place = width > 0 ? static_cast<std::size_t>((motion.time - begin) / width) : 0;
    tenths[std::min(parts - 1, place)].add(motion, T_a_b, rest[i]);
  }
  fit.rotation_median = quantile(whole.rotation, 0.5);
  fit.rotation_95 = quantile(whole.rotation, 0.95);
  fit.translation_median = quantile(whole.translation, 0.5);
  fit.translation_95 = quantile(whole.translation, 0.95);
  fit.translation_relative_median = quantile(whole.relative, 0.5);
  fit.length_ratio = median_ratio(
      motions.all, [](const Motion& motion) { return motion.t_a.norm(); },
      [](const Motion& motion) { return motion.t_b.norm(); });
  fit.turning_ratio = median_ratio(
      motions.all, [](const Motion& motion) { return motion.angle_a; },
      [](const Motion& motion) { return motion.angle_b; });
  for (std::size_t i = 0; i < parts; ++i) {
    const auto k = static_cast<double>(i);
    fit.tenths.push_back({begin + k * width, begin + (k + 1) * width, median_if_any(tenths[i].rotation),
                          median_if_any(tenths[i].translation), median_if_any(tenths[i].relative)});
  }
  return fit;
}

double relative_by_way(const Motions& motions, const Pose& T_a_b) {
  std::vector<std::pair<double, double>> parts;
  for (const Motion& motion : motions.all)
    if (const double length = 0.5 * (motion.t_a.norm() + motion.t_b.norm()); length > 0)
      parts.emplace_back(residual_at(motion, T_a_b).translation / length, length);
  return parts.empty() ? 0 : weighted_median(std::move(parts));
}

}  // namespace egocal::detail
