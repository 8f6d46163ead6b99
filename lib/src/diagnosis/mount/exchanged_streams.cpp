// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/exchanged_streams.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "diagnosis/motions/robust_fit.hpp"

namespace egocal::detail {

bool exchanged_streams(const Motions& motions, double time, const DiagnosisOptions& options,
                       const ExchangedStreamsOptions& tuning) {
  const auto later = std::find_if(motions.all.begin(), motions.all.end(),
                                  [&](const Motion& motion) { return motion.time > time; });
  const auto at = static_cast<std::size_t>(later - motions.all.begin());
  const std::size_t n = motions.all.size();
  if (at < options.motions.least || n - at < options.motions.least) return false;
  const Motions before = part_of(motions, 0, at), after = part_of(motions, at, n);
  const auto is_inverse = [&](const Motions& part, const Motions& other) {
    const Pose T = to_pose(robust_fit(part, options.fit).T);
    const double left = std::sqrt(evaluated(other, to_dual_quaternion(inverse(T))).typical);
    return left < tuning.most &&
           left < tuning.part * std::sqrt(evaluated(other, to_dual_quaternion(T)).typical);
  };
  return is_inverse(before, after) && is_inverse(after, before);
}

}  // namespace egocal::detail
