// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/mount_pairs.hpp"

#include <algorithm>

#include "diagnosis/motions/pairs_over.hpp"
#include "egocal/pairing/congruence.hpp"

namespace egocal::detail {

namespace {

/// Congruent motion pairs of one stride; in planar mode as seen from the planes.
std::vector<MotionPair> pairs_of(const Instants& instants, const Answered& answered,
                                 const DiagnosisOptions& options, const PoseReading& reading,
                                 std::size_t steps) {
  // overlapping motions of a long drive say little that is new
  const std::size_t each = std::clamp<std::size_t>(instants.size() / options.mount.most_motions, 1, steps);
  std::vector<MotionPair> pairs = pairs_over(instants, reading, steps, each, 0, options.motions);
  if (answered.problem.mode == Mode::planar)
    see_from_planes(answered.problem.plane_a, answered.problem.plane_b, pairs);
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
