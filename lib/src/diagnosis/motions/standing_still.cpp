// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/standing_still.hpp"

#include <algorithm>
#include <utility>

#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

bool standing_still(const Instants& instants, const StandingStillOptions& options) {
  const std::size_t n = instants.size();
  const std::size_t each = std::max<std::size_t>(1, n / options.most_pairs);
  const auto small = [&options](const DualQuaternion& motion) {
    return rotation_angle(canonical_sign(motion)) <= options.rotation &&
           translation_length(motion) <= options.translation;
  };
  // a way there and back may end where it began after a half, or after a third, but not after both
  for (const std::size_t apart : {n / 2, n / 3}) {
    if (apart == 0) return false;
    std::size_t pairs = 0, still = 0;
    for (std::size_t i = 0; i + apart < n; i += each) {
      const PosePair from = instants.at(i), to = instants.at(i + apart);
      ++pairs;
      if (small(conjugate(from.a) * to.a) && small(conjugate(from.b) * to.b)) ++still;
    }
    if (static_cast<double>(still) < options.part * static_cast<double>(pairs)) return false;
  }
  return true;
}

namespace {

double length_of(const Motion& motion) {
  return std::max(motion.t_a.norm(), motion.t_b.norm());
}

double angle_of(const Motion& motion) {
  return std::max(motion.angle_a, motion.angle_b);
}

/// Half of the whole is made of larger ones; of both sensors the smaller one, as wrong poses are large.
double usual_size(const Motions& motions, double (*size)(const Motion&)) {
  std::vector<std::pair<double, double>> sizes;
  for (const Motion& motion : motions.all) sizes.emplace_back(size(motion), size(motion));
  return weighted_median(std::move(sizes));
}

double smaller_length(const Motion& motion) {
  return std::min(motion.t_a.norm(), motion.t_b.norm());
}

double smaller_angle(const Motion& motion) {
  return std::min(motion.angle_a, motion.angle_b);
}

}  // namespace

double usual_angle(const Motions& motions) {
  return usual_size(motions, smaller_angle);
}

std::vector<bool> one_at_rest(const Motions& motions, const RestOptions& options) {
  const double longest = options.length * usual_size(motions, smaller_length),
               largest = options.angle * usual_angle(motions);
  std::vector<bool> rest;
  for (const Motion& motion : motions.all)
    rest.push_back(smaller_length(motion) <= longest && smaller_angle(motion) <= largest);
  return rest;
}

std::vector<bool> at_rest(const Motions& motions, const Pose& T_a_b, const RestOptions& options) {
  const double longest = options.length * usual_size(motions, smaller_length),
               largest = options.angle * usual_angle(motions);
  std::vector<bool> rest;
  std::vector<double> rotations, translations;
  for (const Motion& motion : motions.all) {
    rest.push_back(length_of(motion) <= longest && angle_of(motion) <= largest);
    if (!rest.back()) continue;
    const Residual residual = residual_at(motion, T_a_b);
    rotations.push_back(residual.rotation);
    translations.push_back(residual.translation);
  }
  if (rotations.empty()) return rest;
  const double angle = options.of_noise * median(std::move(rotations)),
               length = options.of_noise * median(std::move(translations));
  for (std::size_t i = 0; i < rest.size(); ++i)
    rest[i] = rest[i] && length_of(motions.all[i]) <= length && angle_of(motions.all[i]) <= angle;
  return rest;
}

Motions without_rest(const Motions& motions, const Pose& T_a_b, const RestOptions& options) {
  const std::vector<bool> rest = at_rest(motions, T_a_b, options);
  const auto count = static_cast<double>(std::count(rest.begin(), rest.end(), true));
  if (count < options.least_part * static_cast<double>(rest.size())) return motions;
  Motions moving = motions;
  moving.all.clear();
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (!rest[i]) moving.all.push_back(motions.all[i]);
  moving.blocks = std::max<std::size_t>(1, motions.blocks * moving.all.size() / motions.all.size());
  measure_sizes(moving);
  return moving;
}

}  // namespace egocal::detail
