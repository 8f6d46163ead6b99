// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "egocal/problem/cost.hpp"
#include "rig/joint.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// Lengths in another unit, each pair divided by the minimum that the whole drive has for it: it is the
/// weight of the pair, which a part of the drive does not change.
std::vector<JointPair> weighted(std::span<const RigEdge> edges, const std::vector<double>& minima,
                                double length) {
  std::vector<JointPair> pairs;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    pairs.push_back(joint_pair(edges[i], length));
    pairs.back().Q /= minima[i];
  }
  return pairs;
}

std::vector<Vector6d> changes(std::span<const JointPair> pairs, const std::vector<DualQuaternion>& start,
                              double length) {
  const std::vector<DualQuaternion> poses = minimise_joint(pairs, start);
  std::vector<Vector6d> result;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Vector6d x = frame_a_difference(start[i], poses[i]);
    x.head<3>() *= length;
    result.push_back(x);
  }
  return result;
}

/// Variances of each pose from its changes by omitted parts.
std::vector<Vector6d> variances(const std::vector<std::vector<Vector6d>>& parts, std::size_t sensors) {
  const double count = static_cast<double>(parts.size());
  std::vector<Vector6d> result(sensors, Vector6d::Zero());
  for (std::size_t s = 0; s < sensors; ++s) {
    Vector6d mean = Vector6d::Zero();
    for (const auto& part : parts) mean += part[s] / count;
    for (const auto& part : parts) result[s] += (part[s] - mean).cwiseAbs2() * ((count - 1) / count);
  }
  return result;
}

}  // namespace

std::vector<std::array<double, 6>> joint_spread(std::span<const RigEdge> edges,
                                                std::span<const std::vector<RigEdge>> without,
                                                std::span<const DualQuaternion> optima,
                                                const std::vector<DualQuaternion>& poses) {
  const double length = length_scale(edges.front().Q);
  std::vector<double> minima;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    JointPair pair = joint_pair(edges[i], length);
    pair.optimum = in_units_of(length, optima[i]);
    minima.push_back(minimum_of(pair));
  }
  std::vector<DualQuaternion> start;
  for (const DualQuaternion& pose : poses) start.push_back(in_units_of(length, pose));
  std::vector<std::vector<Vector6d>> single, pairs_of_parts;
  for (const std::vector<RigEdge>& part : without)
    single.push_back(changes(weighted(part, minima, length), start, length));
  // neighbours together: their errors may be related
  for (std::size_t k = 0; k + 1 < without.size(); k += 2) {
    std::vector<RigEdge> both = without[k];
    for (std::size_t i = 0; i < both.size(); ++i) both[i].Q += without[k + 1][i].Q - edges[i].Q;
    pairs_of_parts.push_back(changes(weighted(both, minima, length), start, length));
  }
  const std::vector<Vector6d> of_single = variances(single, poses.size()),
                              of_pairs = variances(pairs_of_parts, poses.size());
  std::vector<std::array<double, 6>> result(poses.size());
  for (std::size_t s = 0; s < poses.size(); ++s)
    for (std::size_t i = 0; i < 6; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double variance = std::max(of_single[s][k], of_pairs[s][k]);
      result[s][i] = std::isfinite(variance) ? std::sqrt(variance) : INFINITY;
    }
  return result;
}

}  // namespace egocal::detail
