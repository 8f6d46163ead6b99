// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "scale/unjudged_motions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "egocal/microseconds.hpp"

namespace egocal::detail {

PairingOptions unjudged(PairingOptions pairing, int stride) {
  pairing.stride = stride;
  pairing.balance = Balance{};
  pairing.robust = false;
  return pairing;
}

std::vector<MotionPair> unjudged_motions(const Trajectory& a, const Trajectory& b, PairingOptions pairing,
                                         double length) {
  const Trajectory& slower = a.size() < b.size() ? a : b;
  if (slower.size() < 2) return {};
  const double span = to_seconds(slower.back().time_us - slower.front().time_us);
  const double period = span / static_cast<double>(slower.size() - 1);
  pairing.track_time_offset = false;
  const double steps = std::clamp(std::round(length / std::max(period, 1e-6)), 1.0, 64.0);
  std::vector<MotionPair> motions;
  for (int stride = static_cast<int>(steps); stride > 0 && motions.empty(); stride /= 2) {
    PairingResult result = pair_motions(unjudged(pairing, stride), a, b);
    motions = std::move(result.pairs);
    if (result.drive.counts().synchronised < 2) break;  // no shorter ones, either
  }
  return motions;
}

}  // namespace egocal::detail
