// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/mount_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/microseconds.hpp"
#include "egocal/pairing/congruence.hpp"

namespace egocal::detail {

namespace {

/// Motion pairs of one stride, none across a gap; in planar mode as seen from the planes.
std::vector<MotionPair> pairs_of(const Instants& instants, const Answered& answered,
                                 const DiagnosisOptions& options, const PoseReading& reading,
                                 std::size_t steps) {
  const bool planar = answered.problem.mode == Mode::planar;
  const DualQuaternion G_a = planar ? plane_frame(answered.problem.plane_a) : DualQuaternion{};
  const DualQuaternion G_b = planar ? plane_frame(answered.problem.plane_b) : DualQuaternion{};
  std::vector<MotionPair> pairs;
  // overlapping motions of a long drive say little that is new
  const std::size_t each = std::clamp<std::size_t>(instants.size() / options.mount.most_motions, 1, steps);
  const double longest = options.motions.most_stretched * static_cast<double>(steps) * instants.period;
  pairs.reserve(instants.size() / each + 1);
  MotionEnds ends(instants, reading, reading, steps, each);
  for (std::size_t i = 0; i + steps < instants.size(); i += each) {
    const std::size_t k = i + steps;
    if (instants.time(k) - instants.time(i) > longest) continue;
    ends.fetch_next(i, k);
    const PosePair from = ends.at(i), to = ends.at(k);
    MotionPair pair{canonical_sign(normalized(conjugate(from.a) * to.a)),
                    canonical_sign(normalized(conjugate(from.b) * to.b)), to_microseconds(instants.time(i)),
                    to_microseconds(instants.time(k)), 1};
    if (planar) {
      pair.a = planar_motion(pair.a, G_a);
      pair.b = planar_motion(pair.b, G_b);
    }
    pairs.push_back(pair);
  }
  const std::vector<bool> wrong = incongruent(pairs, {});
  std::size_t i = 0;
  std::erase_if(pairs, [&](const MotionPair&) { return wrong[i++]; });
  return pairs;
}

}  // namespace

std::vector<std::vector<MotionPair>> strides_of(const Instants& instants, const Answered& answered,
                                                const DiagnosisOptions& options, const PoseReading& reading) {
  const MountCheckOptions& mount = options.mount;
  const std::size_t longest = std::max<std::size_t>(1, instants.size() / (3 * mount.blocks));
  const std::size_t steps =
      std::min(longest, std::max(mount.least_stride, static_cast<std::size_t>(std::max(1, answered.stride))));
  const std::size_t shortest = std::clamp<std::size_t>(instants.size() / mount.most_motions, 1, steps);
  std::vector<std::vector<MotionPair>> strides;
  strides.push_back(pairs_of(instants, answered, options, reading, shortest));
  if (steps > shortest) strides.push_back(pairs_of(instants, answered, options, reading, steps));
  return strides;
}

}  // namespace egocal::detail
