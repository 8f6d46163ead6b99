// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/extrinsics/tree_of_rig.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

#include "offline/extrinsics/named_extrinsic.hpp"

namespace egocal::tools {

namespace {

/// Judges an edge of the joint answer like its pair, which agrees with it, and as not good where it may be
/// off by more than is tolerated.
void judge_joint(const Calibration& pair, NamedExtrinsic& edge) {
  if (pair.verdict != Verdict::good) return;
  constexpr double confidence = 1.96;  // mathematics: 95 % of a normal distribution
  const DiagnosisOptions options;
  const Eigen::Map<const Eigen::Vector3d> translation(edge.stddev->data()), rotation(edge.stddev->data() + 3);
  const bool known = confidence * translation.norm() <= options.tolerance_translation &&
                     confidence * rotation.norm() <= options.tolerance_rotation;
  edge.verdict = to_string(known ? Verdict::good : Verdict::incomplete);
  edge.reason = known ? "All pairs agree with one set of extrinsics, and all directions are known."
                      : "All pairs agree with one set of extrinsics, which is not known well enough yet.";
}

/// why: RigReport::unusable. A good answer in a loop that does not close is not good.
void judge_edge(const std::string& why, Verdict of_pair, NamedExtrinsic& edge) {
  if (why.empty()) return;
  edge.usable = false;
  edge.verdict = to_string(of_pair < Verdict::doubtful ? Verdict::contradictory : of_pair);
  edge.reason = why;
}

}  // namespace

ExtrinsicTree tree_of(const RigReport& report) {
  const auto is_apart = [&report](std::size_t sensor) {
    return std::find(report.apart.begin(), report.apart.end(), sensor) != report.apart.end();
  };
  std::size_t root = 0;
  while (is_apart(root)) ++root;
  std::vector<NamedExtrinsic> edges;
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    const RigPairAnswer& pair = report.solution.pairs[i];
    if (is_apart(pair.a)) continue;
    NamedExtrinsic edge = named_extrinsic(report.names[pair.a], report.names[pair.b], report.pairs[i]);
    if (report.joint) {
      if (pair.a != 0) continue;
      const ConsistentSet& set = report.solution.set;
      edge.T_parent_child = to_pose(set.poses[pair.b]);
      edge.certified = set.certified;
      edge.stddev = set.stddev[pair.b];
      judge_joint(report.pairs[i], edge);
    }
    judge_edge(report.unusable[i], report.pairs[i].verdict, edge);
    edges.push_back(std::move(edge));
  }
  if (report.joint) return {report.names[0], std::move(edges), {}};
  return extrinsic_tree(edges, report.names[root]);
}

}  // namespace egocal::tools
