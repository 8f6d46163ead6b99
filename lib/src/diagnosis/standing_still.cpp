// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/standing_still.hpp"

#include <algorithm>

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

}  // namespace egocal::detail
