// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/in_parts.hpp"

#include <algorithm>
#include <cstddef>

namespace egocal::detail {

std::vector<std::size_t> bounds_of_parts(const Motions& motions, const std::vector<Finding>& moves,
                                         const PartsOptions& options) {
  std::vector<std::size_t> bounds{0};
  for (std::size_t k = 0; k <= moves.size(); ++k) {
    std::size_t to = motions.all.size();
    if (k < moves.size() && moves[k].time)
      while (to > bounds.back() && motions.all[to - 1].time > *moves[k].time) --to;
    const std::size_t from = bounds.back();
    const bool creeps = k > 0 && moves[k - 1].change == MountingChange::slowly;  // until the next move
    const std::size_t parts = creeps ? options.of_creep : 1;
    for (std::size_t part = 1; part <= parts; ++part)
      if (const std::size_t bound = from + part * (to - from) / parts; bound > bounds.back())
        bounds.push_back(bound);
  }
  return bounds;
}

Explained in_parts(const Motions& motions, const std::vector<Finding>& moves,
                   const DiagnosisOptions& options) {
  Explained result{motions, {}};
  const std::vector<std::size_t> bounds = bounds_of_parts(motions, moves);
  for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
    const RobustFit fit = robust_fit(part_of(motions, bounds[k], bounds[k + 1]), options.fit);
    result.fit.squares.insert(result.fit.squares.end(), fit.squares.begin(), fit.squares.end());
    result.fit.typical = std::max(result.fit.typical, fit.typical);
  }
  return result;
}

}  // namespace egocal::detail
