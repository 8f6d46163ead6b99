// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/twist_integrator.hpp"

#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "linear_algebra/screw_matrix.hpp"

namespace egocal {

namespace {

/// The motion of a constant twist over a time: the exponential of SE(3).
Pose screw(const Eigen::Vector3d& way, const Eigen::Vector3d& turn) {
  return {rotation_exp(turn), detail::screw_matrix(turn) * way};
}

}  // namespace

std::optional<DualQuaternion> TwistIntegrator::add(const Twist& twist) {
  if (!twist.linear.allFinite() || !twist.angular.allFinite()) return std::nullopt;
  if (last_) {
    if (twist.time_us <= last_->time_us) return std::nullopt;
    const double step_s = to_seconds(twist.time_us - last_->time_us);
    const Pose step =
        screw(0.5 * step_s * (last_->linear + twist.linear), 0.5 * step_s * (last_->angular + twist.angular));
    // a damaged velocity may be finite, and its way not
    const Eigen::Vector4d q(step.rotation.w(), step.rotation.x(), step.rotation.y(), step.rotation.z());
    const Eigen::Vector3d way = step.translation;
    if (!q.allFinite() || !way.allFinite() || !plausible_distance(way.cwiseAbs().maxCoeff()))
      return std::nullopt;
    const DualQuaternion next = normalized(pose_ * to_dual_quaternion(step));
    const Eigen::Vector3d place = to_pose(next).translation;
    if (!plausible_distance(place.cwiseAbs().maxCoeff())) return std::nullopt;
    pose_ = next;
  }
  last_ = twist;
  return pose_;
}

}  // namespace egocal
