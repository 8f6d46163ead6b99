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
  const RobustFit of_before = robust_fit(before, options.fit), of_after = robust_fit(after, options.fit);
  const auto is_inverse = [&](const RobustFit& part, const Motions& other, const RobustFit& of_other) {
    const double left = std::sqrt(evaluated(other, to_dual_quaternion(inverse(to_pose(part.T)))).typical);
    return left < tuning.most && left < tuning.than_own * std::sqrt(of_other.typical) &&
           left < tuning.part * std::sqrt(evaluated(other, part.T).typical);
  };
  return is_inverse(of_before, after, of_after) && is_inverse(of_after, before, of_before);
}

}  // namespace egocal::detail
