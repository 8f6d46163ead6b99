// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/changed_motions.hpp"

namespace egocal::detail {

std::vector<std::size_t> begins_of(const Instants& instants, const Motions& motions) {
  const auto span = static_cast<std::size_t>(motions.stride);
  std::vector<std::size_t> begins;
  begins.reserve(motions.all.size());
  std::size_t i = 0;
  for (const Motion& motion : motions.all) {
    while (i + span + 1 < instants.size() &&
           0.5 * (instants.time(i) + instants.time(i + span)) < motion.time - 1e-9)
      ++i;
    begins.push_back(i);
  }
  return begins;
}

void set_motion(Motion& motion, Side side, const Rotation& rotation, const Eigen::Vector3d& translation) {
  (side == Side::a ? motion.t_a : motion.t_b) = translation;
  (side == Side::a ? motion.a : motion.b) = canonical_sign(to_dual_quaternion(Pose{rotation, translation}));
}

Motions with_added(Motions motions, const std::vector<Eigen::Vector3d>& added, Side side) {
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    Motion& motion = motions.all[i];
    set_motion(motion, side, to_pose(side == Side::a ? motion.a : motion.b).rotation,
               (side == Side::a ? motion.t_a : motion.t_b) + added[i]);
  }
  return motions;
}

void set_turned_motion(Motion& motion, Side side, const Rotation& rotation,
                       const Eigen::Vector3d& translation) {
  set_motion(motion, side, rotation, translation);
  (side == Side::a ? motion.angle_a : motion.angle_b) = rotation_angle(side == Side::a ? motion.a : motion.b);
  if (side == Side::a) motion.R_a = rotation.toRotationMatrix();
}

}  // namespace egocal::detail
