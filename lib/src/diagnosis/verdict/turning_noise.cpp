// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/turning_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Half of the squared differences between the halves of each motion of one stream: of the turns [rad^2], and
/// of the logarithms of the lengths.
struct UnlikeHalves {
  std::vector<double> turns, lengths;

  void add(const DualQuaternion& first, const DualQuaternion& second, const DualQuaternion& third) {
    const Pose before = to_pose(conjugate(first) * second), after = to_pose(conjugate(second) * third);
    turns.push_back(0.5 * (rotation_log(after.rotation) - rotation_log(before.rotation)).squaredNorm());
    const double length = before.translation.norm(), next = after.translation.norm();
    if (!(length > 0 && next > 0)) return;
    const double unlike = std::log(next / length);
    lengths.push_back(0.5 * unlike * unlike);
  }
};

double median_or_zero(std::vector<double> values) {
  return values.empty() ? 0 : median(std::move(values));
}

}  // namespace

bool steps_leave_noise(const Instants& instants, const Motions& motions, const Pose& T,
                       const TurningNoiseOptions& options) {
  const auto half = static_cast<std::size_t>(std::max(1, motions.stride / 2));
  UnlikeHalves of_a, of_b;
  std::vector<double> turns_left, lengths_left;
  const std::vector<std::size_t> begins = begins_of(instants, motions);
  for (std::size_t k = 0; k < begins.size(); ++k) {
    const Motion& motion = motions.all[k];
    const double turned = residual_at(motion, T).rotation;
    turns_left.push_back(turned * turned);
    const double at_b = (motion.R_a * T.translation + motion.t_a - T.translation).norm(),
                 of_file = motion.t_b.norm();
    if (at_b > 0 && of_file > 0) {
      const double left = std::log(of_file / at_b);
      lengths_left.push_back(left * left);
    }
    const std::size_t i = begins[k];
    if (i + 2 * half >= instants.size()) continue;
    const PosePair first = instants.at(i), second = instants.at(i + half), third = instants.at(i + 2 * half);
    of_a.add(first.a, second.a, third.a);
    of_b.add(first.b, second.b, third.b);
  }
  if (of_a.turns.empty()) return false;
  // a random walk: over the whole motion it turns further, and is a smaller part of the length
  const double longer = static_cast<double>(motions.stride) / static_cast<double>(half);
  const double turns =
      longer * (median_or_zero(std::move(of_a.turns)) + median_or_zero(std::move(of_b.turns)));
  const double lengths =
      (median_or_zero(std::move(of_a.lengths)) + median_or_zero(std::move(of_b.lengths))) / longer;
  return turns >= options.least * median_or_zero(std::move(turns_left)) &&
         lengths >= options.least * median_or_zero(std::move(lengths_left));
}

}  // namespace egocal::detail
