// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/scale/scale_statistics.hpp"

#include <algorithm>
#include <utility>

namespace egocal {

void ScaleStatistics::add(const DualQuaternion& a, const DualQuaternion& b, double eta) {
  const DualQuaternion p = canonical_sign(a), q = canonical_sign(b);
  const Eigen::Matrix4d E_r = right_matrix(q.real) - left_matrix(p.real);
  const Eigen::Matrix4d R = right_matrix(q.dual), L = left_matrix(p.dual);
  const Eigen::Matrix4d RL = R.transpose() * L;
  rotation += eta * (E_r.transpose() * E_r);
  coupling_a -= eta * (L.transpose() * E_r);
  coupling_b += eta * (R.transpose() * E_r);
  cross -= eta * (RL + RL.transpose());
  square_a += eta * p.dual.squaredNorm();
  square_b += eta * q.dual.squaredNorm();
  weight += eta;
  ++count;
}

ScaleStatistics& ScaleStatistics::operator+=(const ScaleStatistics& other) {
  rotation += other.rotation;
  coupling_a += other.coupling_a;
  coupling_b += other.coupling_b;
  cross += other.cross;
  square_a += other.square_a;
  square_b += other.square_b;
  weight += other.weight;
  count += other.count;
  return *this;
}

ScaleStatistics& ScaleStatistics::operator-=(const ScaleStatistics& other) {
  rotation -= other.rotation;
  coupling_a -= other.coupling_a;
  coupling_b -= other.coupling_b;
  cross -= other.cross;
  square_a -= other.square_a;
  square_b -= other.square_b;
  weight -= other.weight;
  count -= other.count;
  return *this;
}

ScaleStatistics sum_blocks(std::span<const ScaleStatistics> blocks) {
  ScaleStatistics sum;
  for (const ScaleStatistics& block : blocks) sum += block;
  return sum;
}

ScaleStatistics with_scale_on_b(const ScaleStatistics& statistics) {
  ScaleStatistics result = statistics;
  std::swap(result.coupling_a, result.coupling_b);
  std::swap(result.square_a, result.square_b);
  return result;
}

Statistics at_scale(const ScaleStatistics& statistics, double scale) {
  Statistics result;
  const Eigen::Matrix4d square =
      (statistics.square_b + scale * scale * statistics.square_a) * Eigen::Matrix4d::Identity() +
      scale * statistics.cross;
  const Eigen::Matrix4d coupling = statistics.coupling_b + scale * statistics.coupling_a;
  result.dual_rows.topLeftCorner<4, 4>() = square;
  result.dual_rows.topRightCorner<4, 4>() = coupling;
  result.dual_rows.bottomLeftCorner<4, 4>() = coupling.transpose();
  result.dual_rows.bottomRightCorner<4, 4>() = statistics.rotation;
  result.weight = statistics.weight;
  result.count = statistics.count;
  return result;
}

std::vector<ScaleStatistics> scale_blocks(std::span<const MotionPair> pairs, std::size_t blocks,
                                          std::size_t least_pairs) {
  const std::size_t possible = std::max<std::size_t>(1, pairs.size() / std::max<std::size_t>(1, least_pairs));
  const std::size_t count = std::min(std::max<std::size_t>(1, blocks), possible);
  std::vector<ScaleStatistics> result(pairs.empty() ? 0 : count);
  for (std::size_t i = 0; i < pairs.size(); ++i) result[i * count / pairs.size()].add(pairs[i]);
  return result;
}

DualQuaternion scaled(const DualQuaternion& motion, double scale) {
  return {motion.real, scale * motion.dual};
}

Trajectory scaled(const Trajectory& trajectory, double scale) {
  Trajectory result = trajectory;
  for (StampedPose& pose : result) pose.pose = scaled(pose.pose, scale);
  return result;
}

}  // namespace egocal
