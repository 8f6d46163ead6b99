// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig_report.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "degrees.hpp"
#include "offline/trust_report.hpp"

namespace egocal::tools {

namespace {

using Json = nlohmann::ordered_json;

void add_pose(Json& json, const Pose& T) {
  json["translation"] = {T.translation.x(), T.translation.y(), T.translation.z()};
  json["rotation_wxyz"] = {T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z()};
}

double length(const std::array<double, 6>& x, std::size_t from) {
  return Eigen::Map<const Eigen::Vector3d>(x.data() + from).norm();
}

Json name_of(const RigReport& report, const std::optional<std::size_t>& sensor) {
  return sensor ? Json(report.names[*sensor]) : Json();
}

Json finding_json(const RigReport& report, const RigFinding& finding) {
  Json json;
  json["code"] = finding.code;
  json["sensor"] = name_of(report, finding.sensor);
  json["message"] = finding.message;
  json["remedy"] = finding.remedy;
  if (finding.value) json["value"] = *finding.value;
  if (!finding.move) return json;
  const Move& move = finding.move->move;
  const RigPairAnswer& pair = report.solution.pairs[finding.move->pair];
  const double begin = *finding.time - move.time;
  json["kind"] = move.kind == MoveKind::creep ? "creep" : "bump";
  json["time"] = *finding.time;
  json["earliest"] = begin + move.earliest;
  json["latest"] = begin + move.latest;
  json["a"] = report.names[pair.a];
  json["b"] = report.names[pair.b];
  json["change"] = move.change;
  json["change_stddev"] = move.stddev;
  json["false_alarm"] = move.false_alarm;
  add_pose(json["before"], to_pose(move.before));
  add_pose(json["after"], to_pose(move.after));
  return json;
}

Json extrinsic_json(const RigReport& report, std::size_t i) {
  const Calibration& calibration = report.pairs[i];
  const RigPairAnswer& pair = report.solution.pairs[i];
  const Certificate& certificate = pair.certificate;
  Json json;
  json["a"] = report.names[pair.a];
  json["b"] = report.names[pair.b];
  add_pose(json, calibration.T_a_b);
  const Json trust = trust_json(calibration);
  for (const char* key : {"verdict", "reason", "fit", "findings"}) json[key] = trust[key];
  json["pairs"] = sum_blocks(calibration.problem.blocks).count;
  json["cost"] = certificate.cost;
  json["lower_bound"] = certificate.lower_bound;
  json["gap"] = certificate.gap;
  json["certified"] = certificate.optimality == Optimality::certified;
  json["observable"] = calibration.observability.observable;
  json["stddev"] = calibration.observability.stddev;
  json["stride"] = calibration.choice.stride;
  json["weights"] = {{"rotation", calibration.choice.balance.rotation},
                     {"translation", calibration.choice.balance.translation}};
  json["time_offset_s"] = calibration.time_offset_applied;
  return json;
}

Json loop_json(const RigReport& report, const Loop& loop) {
  Json json;
  json["sensors"] = Json::array();
  for (const std::size_t sensor : loop.sensors) json["sensors"].push_back(report.names[sensor]);
  json["translation_m"] = length(loop.misfit, 0);
  json["rotation_deg"] = degrees * length(loop.misfit, 3);
  json["misfit"] = loop.misfit;
  json["stddev"] = loop.stddev;
  json["chi_square"] = loop.chi_square;
  json["false_alarm"] = loop.false_alarm;
  json["closed"] = loop.closed;
  return json;
}

std::string pose_numbers(const Pose& T) {
  return fmt::format("{:9.4f} {:9.4f} {:9.4f}  {:9.6f} {:9.6f} {:9.6f} {:9.6f}", T.translation.x(),
                     T.translation.y(), T.translation.z(), T.rotation.w(), T.rotation.x(), T.rotation.y(),
                     T.rotation.z());
}

/// One standard deviation, the largest of three directions; "-" where one is not known.
std::string largest_stddev(const Observability& observability, std::size_t from, double unit,
                           const char* name) {
  double largest = 0;
  for (std::size_t i = from; i < from + 3; ++i) {
    if (!observability.observable[i] || !std::isfinite(observability.stddev[i])) return "-";
    largest = std::max(largest, observability.stddev[i]);
  }
  return fmt::format("{:.3f} {}", unit * largest, name);
}

std::string label_of(const RigReport& report, std::size_t a, std::size_t b) {
  return report.names[a] + " -> " + report.names[b];
}

std::string pairs_text(const RigReport& report, std::size_t width) {
  std::string text = fmt::format("{:<{}}  {:>29}  {:>39}  {:>10}  {:>10}  {}\n", "pair: b in a", width,
                                 "x y z [m]", "quaternion w x y z", "+-", "+-", "verdict, optimality");
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    const Calibration& calibration = report.pairs[i];
    const RigPairAnswer& pair = report.solution.pairs[i];
    text += fmt::format("{:<{}}  {}  {:>10}  {:>10}  {}, {}\n", label_of(report, pair.a, pair.b), width,
                        pose_numbers(calibration.T_a_b),
                        largest_stddev(calibration.observability, 3, degrees, "deg"),
                        largest_stddev(calibration.observability, 0, 100, "cm"),
                        to_string(calibration.verdict), to_string(pair.certificate.optimality));
  }
  return text;
}

std::string loops_text(const RigReport& report) {
  std::string text;
  for (const Loop& loop : report.solution.loops)
    text += fmt::format("loop          {} -> {} -> {}: {}, misfit {:.3f} deg, {:.2f} cm (chance {:.2g})\n",
                        report.names[loop.sensors[0]], report.names[loop.sensors[1]],
                        report.names[loop.sensors[2]], loop.closed ? "closed" : "OPEN",
                        degrees * length(loop.misfit, 3), 100 * length(loop.misfit, 0), loop.false_alarm);
  return text;
}

std::string set_text(const RigReport& report, std::size_t width) {
  const ConsistentSet& set = report.solution.set;
  std::string text = fmt::format("\none consistent set, {}: every sensor in {}\n",
                                 !set.solved     ? "of the pairs with the first sensor"
                                 : set.certified ? "optimal (proven: none fits all pairs better)"
                                                 : "optimality UNDECIDED",
                                 report.names[0]);
  for (std::size_t i = 1; i < set.poses.size(); ++i)
    text += fmt::format("{:<{}}  {}\n", label_of(report, 0, i), width, pose_numbers(to_pose(set.poses[i])));
  return text;
}

}  // namespace

Json rig_json(const RigReport& report) {
  const RigSolution& solution = report.solution;
  Json json;
  json["findings"] = Json::array();
  for (const RigFinding& finding : report.findings) json["findings"].push_back(finding_json(report, finding));
  json["blamed"] = name_of(report, report.blamed);
  json["extrinsics"] = Json::array();
  for (std::size_t i = 0; i < report.pairs.size(); ++i)
    json["extrinsics"].push_back(extrinsic_json(report, i));
  json["loops"] = Json::array();
  for (const Loop& loop : solution.loops) json["loops"].push_back(loop_json(report, loop));
  const ConsistentSet& set = solution.set;
  json["joint"]["certified"] = set.certified;
  json["joint"]["cost"] = set.cost;
  json["joint"]["lower_bound"] = set.lower_bound;
  json["joint"]["pairwise_bound"] = set.pairwise_bound;
  json["joint"]["tree"] = Json::array();
  for (std::size_t i = 1; i < set.poses.size(); ++i) {
    Json edge;
    edge["parent"] = report.names[0];
    edge["child"] = report.names[i];
    add_pose(edge, to_pose(set.poses[i]));
    json["joint"]["tree"].push_back(edge);
  }
  json["noise"] = solution.noise;
  return json;
}

std::string rig_text(const RigReport& report) {
  std::size_t width = 12;
  for (const RigPairAnswer& pair : report.solution.pairs)
    width = std::max(width, label_of(report, pair.a, pair.b).size());
  std::string text;
  for (const RigFinding& finding : report.findings)
    text += fmt::format("finding       {}\n              cure: {}\n", finding.message, finding.remedy);
  if (report.blamed) text += fmt::format("blamed        {}\n", report.names[*report.blamed]);
  text += loops_text(report) + "\n" + pairs_text(report, width) + set_text(report, width);
  text.pop_back();
  return text;
}

ExtrinsicTree rig_tree(const RigReport& report) {
  const ConsistentSet& set = report.solution.set;
  ExtrinsicTree tree{report.names[0], {}, {}};
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    const RigPairAnswer& pair = report.solution.pairs[i];
    if (pair.a != 0) continue;
    const Calibration& calibration = report.pairs[i];
    NamedExtrinsic edge;
    edge.parent = report.names[0];
    edge.child = report.names[pair.b];
    edge.T_parent_child = to_pose(set.poses[pair.b]);
    edge.certified = set.certified;
    edge.pairs = static_cast<long long>(sum_blocks(calibration.problem.blocks).count);
    edge.stddev = calibration.observability.stddev;
    for (std::size_t k = 0; k < 6; ++k)
      if (!calibration.observability.observable[k])
        (*edge.stddev)[k] = std::numeric_limits<double>::infinity();
    edge.usable = !report.contradictory;
    tree.edges.push_back(std::move(edge));
  }
  return tree;
}

}  // namespace egocal::tools
