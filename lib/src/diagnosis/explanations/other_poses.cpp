// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/other_poses.hpp"

#include <cstddef>

#include "diagnosis/motions/changed_motions.hpp"

namespace egocal::detail {

std::vector<Pose> poses_of(const Instants& instants, Side side) {
  std::vector<Pose> poses;
  poses.reserve(instants.size());
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const PosePair both = instants.at(i);
    poses.push_back(to_pose(side == Side::a ? both.a : both.b));
  }
  return poses;
}

Explained with_poses(const Instants& instants, const Explained& given, Side side,
                     const std::vector<Pose>& poses, const DiagnosisOptions& options) {
  Explained result{given.motions, {}};
  const auto span = static_cast<std::size_t>(given.motions.stride);
  const std::vector<std::size_t> begins = begins_of(instants, given.motions);
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const Pose motion = inverse(poses[begins[i]]) * poses[begins[i] + span];
    set_turned_motion(result.motions.all[i], side, motion.rotation, motion.translation);
  }
  measure_sizes(result.motions);
  result.fit = robust_fit(result.motions, options.fit);
  return result;
}

}  // namespace egocal::detail
