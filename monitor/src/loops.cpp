// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/loops.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace egocal::monitor {

namespace {

struct Edge {
  Pose T_a_b;
  double rotation = 0, translation = 0;  ///< standard deviations over all axes [rad, m]
};
using Edges = std::map<std::pair<std::string, std::string>, Edge>;

double norm(const double* stddev) {
  return Eigen::Map<const Eigen::Vector3d>(stddev).norm();  // infinite where one is
}

Edges edges_of(const Model& model) {
  Edges edges;
  for (const PairState& pair : model.pairs()) {
    if (!pair.answer() || !pair.shown.valid) continue;
    const double* const stddev = pair.shown.observability.stddev.data();
    const Edge edge{pair.shown.T_a_b, norm(stddev + 3), norm(stddev)};
    edges[{pair.a, pair.b}] = edge;
    edges[{pair.b, pair.a}] = {inverse(edge.T_a_b), edge.rotation, edge.translation};
  }
  return edges;
}

}  // namespace

std::vector<Loop> loops_of(const Model& model, const LoopOptions& options) {
  const Edges edges = edges_of(model);
  std::set<std::string> names;
  for (const auto& [pair, edge] : edges) names.insert(pair.first);
  std::vector<Loop> loops;
  for (const auto& [ab, first] : edges)
    for (const std::string& c : names) {
      const auto& [a, b] = ab;
      if (!(a < b && b < c)) continue;
      const auto second = edges.find({b, c}), third = edges.find({c, a});
      if (second == edges.end() || third == edges.end()) continue;
      const Pose misfit = first.T_a_b * second->second.T_a_b * third->second.T_a_b;
      Loop loop;
      loop.sensors = {a, b, c};
      loop.rotation = rotation_log(misfit.rotation).norm();
      loop.translation = misfit.translation.norm();
      double rotation = 0, translation = 0, arm = 0;
      for (const Edge* edge : {&first, &second->second, &third->second}) {
        rotation += edge->rotation;
        translation += edge->translation;
        arm += edge->T_a_b.translation.norm();
      }
      loop.rotation_limit = options.least_rotation + options.sigmas * rotation;
      // an error of a rotation turns what comes behind it
      loop.translation_limit = options.least_translation + options.sigmas * (translation + rotation * arm);
      loops.push_back(std::move(loop));
    }
  return loops;
}

std::string sensor_to_blame(const std::vector<Loop>& loops) {
  std::set<std::string> common, closed;
  bool first = true;
  for (const Loop& loop : loops) {
    const std::set<std::string> sensors(loop.sensors.begin(), loop.sensors.end());
    if (!loop.open()) {
      closed.insert(sensors.begin(), sensors.end());
    } else if (std::exchange(first, false)) {
      common = sensors;
    } else {
      std::erase_if(common, [&](const std::string& name) { return !sensors.contains(name); });
    }
  }
  std::erase_if(common, [&](const std::string& name) { return closed.contains(name); });
  return common.size() == 1 ? *common.begin() : std::string();
}

}  // namespace egocal::monitor
