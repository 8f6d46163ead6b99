// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/evaluation/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "egocal/error.hpp"
#include "egocal/microseconds.hpp"
#include "linear_algebra/symmetric_eigen.hpp"

namespace egocal {

namespace {

/// The same instant seen by both sensors.
struct Instant {
  Pose a, b_as_a;  ///< T_world_a_a; T_world_b_a
};

std::vector<Instant> common_instants(const Trajectory& a, const Trajectory& b_as_a,
                                     const AlignmentOptions& options) {
  const std::int64_t largest_gap_us = to_microseconds(options.max_gap);
  std::vector<Instant> instants;
  std::size_t after = 0;
  for (const StampedPose& pose : b_as_a) {
    while (after < a.size() && a[after].time_us < pose.time_us) ++after;
    if (after == a.size()) break;
    const bool exact = a[after].time_us == pose.time_us;
    if (!exact && (after == 0 || a[after].time_us - a[after - 1].time_us > largest_gap_us)) continue;
    DualQuaternion at = a[after].pose;
    if (!exact)
      at = interpolate(a[after - 1].pose, a[after].pose,
                       static_cast<double>(pose.time_us - a[after - 1].time_us) /
                           static_cast<double>(a[after].time_us - a[after - 1].time_us));
    instants.push_back({to_pose(at), to_pose(pose.pose)});
  }
  return instants;
}

}  // namespace

Alignment align(const Trajectory& a, const Trajectory& b, const Pose& T_a_b, double time_offset,
                const AlignmentOptions& options) {
  Alignment alignment;
  const DualQuaternion T_b_a = to_dual_quaternion(inverse(T_a_b));
  const std::int64_t offset_us = to_microseconds(time_offset);
  alignment.b_as_a.reserve(b.size());
  for (const StampedPose& pose : b)
    alignment.b_as_a.push_back({pose.time_us + offset_us, normalized(pose.pose * T_b_a)});
  const std::vector<Instant> instants = common_instants(a, alignment.b_as_a, options);
  alignment.compared = instants.size();
  if (instants.empty()) throw Error("align: the two trajectories do not overlap in time");

  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();  // of quaternions, x y z w
  for (const Instant& at : instants) {
    const Eigen::Vector4d q = (at.a.rotation * at.b_as_a.rotation.conjugate()).coeffs();
    sum += q * q.transpose();
  }
  const detail::SymmetricEigen<4> eigen = detail::symmetric_eigen<4>(sum);
  Pose& T = alignment.T_world_a_world_b;
  T.rotation.coeffs() = eigen.vectors.col(3);
  if (T.rotation.w() < 0) T.rotation.coeffs() *= -1;
  T.rotation.normalize();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Instant& at : instants) mean += at.a.translation - T.rotation * at.b_as_a.translation;
  T.translation = mean / static_cast<double>(instants.size());

  for (const Instant& at : instants) {
    const Pose difference = inverse(at.a) * (T * at.b_as_a);
    alignment.rms_translation += difference.translation.squaredNorm();
    alignment.rms_rotation += rotation_log(difference.rotation).squaredNorm();
  }
  const auto count = static_cast<double>(instants.size());
  alignment.rms_translation = std::sqrt(alignment.rms_translation / count);
  alignment.rms_rotation = std::sqrt(alignment.rms_rotation / count);
  const DualQuaternion world = to_dual_quaternion(T);
  for (StampedPose& pose : alignment.b_as_a) pose.pose = normalized(world * pose.pose);
  return alignment;
}

}  // namespace egocal
