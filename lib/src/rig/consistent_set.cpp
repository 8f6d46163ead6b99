// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/rig/rig.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "egocal/problem/cost.hpp"
#include "egocal/solvers/global.hpp"
#include "rig/joint.hpp"

namespace egocal {

namespace {

using detail::JointPair;
using detail::minimum_of;

std::vector<JointPair> joint_pairs(std::span<const RigEdge> edges, double length) {
  std::vector<JointPair> pairs;
  for (const RigEdge& edge : edges) {
    JointPair pair = detail::joint_pair(edge, length);
    pair.optimum = solve_dual(pair.Q).q;
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

/// The sensor with the least noise among those that have a pair with every other one: the proof holds
/// further where the pairs with the reference show more. Sensor 0 where there is none.
std::size_t reference_of(std::size_t sensors, std::span<const JointPair> pairs) {
  std::vector<double> noise(sensors, 0);
  std::vector<std::vector<bool>> met(sensors, std::vector<bool>(sensors, false));
  for (const JointPair& pair : pairs) {
    for (const std::size_t s : {pair.a, pair.b}) noise[s] += minimum_of(pair) / pair.Q.trace();
    met[pair.a][pair.b] = met[pair.b][pair.a] = true;
  }
  std::size_t best = sensors;
  for (std::size_t s = 0; s < sensors; ++s) {
    const auto partners = std::count(met[s].begin(), met[s].end(), true);
    if (static_cast<std::size_t>(partners) + 1 < sensors) continue;
    if (best == sensors || noise[s] < noise[best]) best = s;
  }
  return best == sensors ? 0 : best;
}

/// The cost of a pair as a form of the conjugate: the pose of sensor a in sensor b.
JointPair turned_round(const JointPair& pair) {
  JointPair result{pair.b, pair.a, pair.Q, conjugate(pair.optimum)};
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 8; ++k)
      if ((i % 4 == 0) != (k % 4 == 0)) result.Q(i, k) = -result.Q(i, k);
  return result;
}

/// Exchanges the sensors 0 and `reference`, with a < b, and makes each pair's minimum 1.
void prepare(std::vector<JointPair>& pairs, std::size_t reference) {
  const auto exchanged = [&](std::size_t s) { return s == 0 ? reference : s == reference ? 0 : s; };
  for (JointPair& pair : pairs) {
    pair.a = exchanged(pair.a);
    pair.b = exchanged(pair.b);
    if (pair.a > pair.b) pair = turned_round(pair);
    pair.Q /= minimum_of(pair);
  }
}

/// Poses along the pairs, those with sensor 0 first. Empty where a sensor is not connected.
std::vector<DualQuaternion> chained(std::size_t sensors, std::span<const JointPair> pairs) {
  std::vector<std::optional<DualQuaternion>> poses(sensors);
  poses[0] = DualQuaternion{};
  for (std::size_t round = 1; round < sensors; ++round) {
    const std::vector<std::optional<DualQuaternion>> known = poses;
    for (const JointPair& pair : pairs) {
      if (known[pair.a] && !poses[pair.b]) poses[pair.b] = *known[pair.a] * pair.optimum;
      if (known[pair.b] && !poses[pair.a]) poses[pair.a] = *known[pair.b] * conjugate(pair.optimum);
    }
  }
  std::vector<DualQuaternion> result;
  for (const auto& pose : poses) {
    if (!pose) return {};
    result.push_back(canonical_sign(normalized(*pose)));
  }
  return result;
}

bool usable(std::size_t sensors, const RigEdge& edge) {
  return edge.a < sensors && edge.b < sensors && edge.a != edge.b && edge.Q.allFinite() &&
         edge.Q.trace() > 1e-250 && edge.Q.trace() < 1e250;
}

}  // namespace

ConsistentSet solve_consistent_set(std::size_t sensors, std::span<const RigEdge> edges) {
  ConsistentSet set;
  if (edges.empty()) return set;
  for (const RigEdge& edge : edges)
    if (!usable(sensors, edge)) return set;
  const double length = detail::length_scale(edges.front().Q);
  std::vector<JointPair> pairs = joint_pairs(edges, length);
  const std::size_t reference = reference_of(sensors, pairs);
  prepare(pairs, reference);
  std::vector<DualQuaternion> poses = chained(sensors, pairs);
  if (poses.empty()) return set;
  poses = detail::minimise_joint(pairs, std::move(poses));

  set.solved = true;
  set.cost = detail::joint_cost(pairs, poses);
  set.pairwise_bound = set.lower_bound = 0;
  if (const auto proof = detail::prove_joint_minimum(pairs, poses)) {
    set.cost = std::max(set.cost, proof->lower_bound);
    set.pairwise_bound = proof->pairwise_bound;
    set.lower_bound = proof->lower_bound;
    set.rounding = proof->rounding;
    set.certified = proof->global && set.cost - set.lower_bound <= 2 * set.rounding;
  }
  std::swap(poses[0], poses[reference]);
  for (const DualQuaternion& pose : poses)
    set.poses.push_back(detail::in_units_of(1 / length, detail::relative(poses[0], pose)));
  return set;
}

}  // namespace egocal
