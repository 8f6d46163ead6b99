// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/pairs_over.hpp"

#include "egocal/microseconds.hpp"

namespace egocal::detail {

std::vector<MotionPair> pairs_over(const Instants& instants, const PoseReading& reading, std::size_t steps,
                                   std::size_t each, std::int64_t origin_us,
                                   const MotionSampleOptions& options) {
  const double longest = options.most_stretched * static_cast<double>(steps) * instants.period;
  std::vector<MotionPair> pairs;
  pairs.reserve(instants.size() / each + 1);
  MotionEnds ends(instants, reading, reading, steps, each);
  for (std::size_t i = 0; i + steps < instants.size(); i += each) {
    const std::size_t k = i + steps;
    if (instants.time(k) - instants.time(i) > longest) continue;
    ends.fetch_next(i, k);
    const PosePair from = ends.at(i), to = ends.at(k);
    pairs.push_back({canonical_sign(normalized(conjugate(from.a) * to.a)),
                     canonical_sign(normalized(conjugate(from.b) * to.b)),
                     origin_us + to_microseconds(instants.time(i)),
                     origin_us + to_microseconds(instants.time(k)), 1});
  }
  return pairs;
}

void see_from_planes(const GroundPlane& plane_a, const GroundPlane& plane_b, std::vector<MotionPair>& pairs) {
  const DualQuaternion G_a = plane_frame(plane_a), G_b = plane_frame(plane_b);
  for (MotionPair& pair : pairs) {
    pair.a = planar_motion(pair.a, G_a);
    pair.b = planar_motion(pair.b, G_b);
  }
}

}  // namespace egocal::detail
