// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/printing/rig.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "egocal/bus/pose_json.hpp"
#include "egocal/degrees.hpp"
#include "egocal/evaluation/errors.hpp"
#include "offline/common/backing_of.hpp"
#include "offline/extrinsics/named_extrinsic.hpp"
#include "offline/extrinsics/tree_of_rig.hpp"
#include "offline/printing/trust.hpp"

namespace egocal::tools {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* rotations[] = {"roll", "pitch", "yaw"};

double length(const std::array<double, 6>& x, std::size_t from) {
  return Eigen::Map<const Eigen::Vector3d>(x.data() + from).norm();
}

Json name_of(const RigReport& report, const std::optional<std::size_t>& sensor) {
  return sensor ? Json(report.names[*sensor]) : Json();
}

Json finding_json(const RigReport& report, const RigFinding& finding) {
  Json json;
  json["code"] = finding.code;
  json["certain"] = finding.certain;
  json["sensor"] = name_of(report, finding.sensor);
  json["message"] = finding.message;
  json["remedy"] = finding.remedy;
  if (finding.value) json["value"] = *finding.value;
  const RigPairAnswer& pair = report.solution.pairs[finding.pair];
  json["a"] = report.names[pair.a];
  json["b"] = report.names[pair.b];
  if (finding.time) json["time"] = *finding.time;
  if (!finding.move) return json;
  const Move& move = finding.move->move;
  const double begin = *finding.time - move.time;
  json["kind"] = move.kind == MoveKind::creep ? "creep" : "bump";
  json["earliest"] = begin + move.earliest;
  json["latest"] = begin + move.latest;
  json["change"] = move.change;
  json["change_stddev"] = move.stddev;
  json["false_alarm"] = move.false_alarm;
  bus::put_pose(json["before"], to_pose(move.before));
  bus::put_pose(json["after"], to_pose(move.after));
  return json;
}

Json extrinsic_json(const RigReport& report, std::size_t i) {
  const Calibration& calibration = report.pairs[i];
  const RigPairAnswer& pair = report.solution.pairs[i];
  const Certificate& certificate = pair.certificate;
  Json json;
  json["a"] = report.names[pair.a];
  json["b"] = report.names[pair.b];
  bus::put_pose(json, calibration.T_a_b);
  const Json trust = trust_json(calibration);
  for (const char* key : {"verdict", "reason", "fit", "findings", "goal"})
    if (trust.contains(key)) json[key] = trust[key];
  json["mode"] = calibration.problem.mode == Mode::planar ? "planar" : "spatial";
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
  if (const std::optional<Pose>& truth = report.truths[i]) {
    const ExtrinsicError error =
        extrinsic_error(to_dual_quaternion(*truth), to_dual_quaternion(calibration.T_a_b));
    json["error_translation_m"] = error.translation;
    json["error_rotation_deg"] = degrees_per_radian * error.rotation;
  }
  return json;
}

Json loop_json(const RigReport& report, const Loop& loop) {
  Json json;
  json["sensors"] = Json::array();
  for (const std::size_t sensor : loop.sensors) json["sensors"].push_back(report.names[sensor]);
  json["translation_m"] = length(loop.misfit, 0);
  json["rotation_deg"] = degrees_per_radian * length(loop.misfit, 3);
  json["misfit"] = loop.misfit;
  json["stddev"] = loop.stddev;
  json["chi_square"] = loop.chi_square;
  json["false_alarm"] = loop.false_alarm;
  json["known_directions"] = loop.known;
  json["closed"] = loop.known > 0 ? Json(loop.closed) : Json();
  return json;
}

/// Numbers that are no measurement are not printed: in a table they would be read as one. A quaternion mixes
/// the three rotations.
std::string pose_numbers(const Pose& T, const std::array<Backing, 6>& backing) {
  std::string text;
  for (std::size_t i = 0; i < 3; ++i)
    text += (i > 0 ? " " : "") + (backing[i] == Backing::none
                                      ? fmt::format("{:>9}", "unknown")
                                      : fmt::format("{:9.4f}", T.translation[static_cast<int>(i)]));
  std::string unknown;
  for (std::size_t i = 3; i < 6; ++i)
    if (backing[i] == Backing::none) unknown += std::string(" ") + rotations[i - 3];
  if (!unknown.empty()) return text + fmt::format("  {:>39}", "unknown:" + unknown);
  return text + fmt::format("  {:9.6f} {:9.6f} {:9.6f} {:9.6f}", T.rotation.w(), T.rotation.x(),
                            T.rotation.y(), T.rotation.z());
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
                        pose_numbers(calibration.T_a_b, backing_of(calibration)),
                        largest_stddev(calibration.observability, 3, degrees_per_radian, "deg"),
                        largest_stddev(calibration.observability, 0, 100, "cm"),
                        to_string(calibration.verdict), to_string(pair.certificate.optimality));
  }
  return text;
}

std::string loop_state(const Loop& loop) {
  if (loop.known == 0) return "unknown: its pairs do not know it well enough";
  const std::string misfit =
      fmt::format("misfit {:.3f} deg, {:.2f} cm (chance {:.2g})", degrees_per_radian * length(loop.misfit, 3),
                  100 * length(loop.misfit, 0), loop.false_alarm);
  const std::string part =
      loop.known < 6 ? fmt::format(" in the {} of 6 directions that are known", loop.known) : "";
  return (loop.closed ? "closed" : "OPEN") + part + ", " + misfit;
}

std::string loops_text(const RigReport& report) {
  std::string text;
  for (const Loop& loop : report.solution.loops)
    text += fmt::format("loop          {} -> {} -> {}: {}\n", report.names[loop.sensors[0]],
                        report.names[loop.sensors[1]], report.names[loop.sensors[2]], loop_state(loop));
  return text;
}

std::string unsolved_text(const RigReport& report) {
  std::string text;
  for (const UnsolvedPair& pair : report.unsolved)
    text += fmt::format("no answer     {}: {}\n", label_of(report, pair.a, pair.b), pair.reason);
  return text;
}

/// One standard deviation of an edge, the largest of three directions; "-" where one is not known.
std::string largest_stddev(const NamedExtrinsic& edge, std::size_t from, double unit, const char* name) {
  double largest = 0;
  for (std::size_t i = from; i < from + 3; ++i) {
    const bool of_motions = !edge.backing || (*edge.backing)[i] == Backing::motions;
    if (!edge.stddev || !of_motions || !std::isfinite((*edge.stddev)[i])) return "-";
    largest = std::max(largest, (*edge.stddev)[i]);
  }
  return fmt::format("{:.3f} {}", unit * largest, name);
}

/// The goals of all pairs and the manoeuvre that helps most; nothing where none is stated.
std::string goals_text(const RigReport& report) {
  std::string text;
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    const std::optional<Goal>& goal = report.pairs[i].goal;
    if (!goal) continue;
    const RigPairAnswer& pair = report.solution.pairs[i];
    text += fmt::format("goal          {}: {}\n", label_of(report, pair.a, pair.b), goal_in_words(*goal));
    if (!goal->next.empty()) text += fmt::format("next          {}\n", goal->next);
  }
  return text;
}

std::string names_apart(const RigReport& report) {
  std::string names;
  for (const std::size_t sensor : report.apart) names += (names.empty() ? "" : ", ") + report.names[sensor];
  return names;
}

std::string set_text(const RigReport& report, std::size_t width) {
  const ConsistentSet& set = report.solution.set;
  std::string text = report.joint ? fmt::format("\none consistent set, the joint answer of all pairs, {}\n",
                                                set.certified ? "optimal (proven: none fits all pairs better)"
                                                              : "optimality UNDECIDED")
                                  : fmt::format("\none consistent set, of the most certain pairs: {}\n",
                                                report.why_not_joint);
  if (!report.apart.empty())
    text += fmt::format("not in it, without an answer that connects them: {}\n", names_apart(report));
  for (const NamedExtrinsic& edge : tree_of(report).edges)
    text +=
        fmt::format("{:<{}}  {}  {:>10}  {:>10}  {}, {}\n", edge.parent + " -> " + edge.child, width,
                    pose_numbers(edge.T_parent_child, edge.backing.value_or(std::array<Backing, 6>{})),
                    largest_stddev(edge, 3, degrees_per_radian, "deg"), largest_stddev(edge, 0, 100, "cm"),
                    edge.verdict, edge.certified ? "certified" : "undecided");
  return text;
}

Json tree_json(const RigReport& report) {
  Json tree = Json::array();
  for (const NamedExtrinsic& extrinsic : tree_of(report).edges) {
    Json edge;
    edge["parent"] = extrinsic.parent;
    edge["child"] = extrinsic.child;
    bus::put_pose(edge, extrinsic.T_parent_child);
    edge["verdict"] = extrinsic.verdict;
    edge["reason"] = extrinsic.reason;
    edge["certified"] = extrinsic.certified;
    edge["stddev"] = extrinsic.stddev ? Json(*extrinsic.stddev) : Json();
    tree.push_back(std::move(edge));
  }
  return tree;
}

Json unsolved_json(const RigReport& report) {
  Json pairs = Json::array();
  for (const UnsolvedPair& pair : report.unsolved)
    pairs.push_back({{"a", report.names[pair.a]}, {"b", report.names[pair.b]}, {"reason", pair.reason}});
  return pairs;
}

/// Which edges of the tree a contradiction bears on.
std::string whose(const ExtrinsicTree& tree) {
  const auto bad = std::count_if(tree.edges.begin(), tree.edges.end(),
                                 [](const NamedExtrinsic& edge) { return !edge.usable; });
  if (bad == 0) return "It bears on no extrinsic of the tree.";
  if (bad == std::ssize(tree.edges)) return "Do not use these extrinsics.";
  return "Do not use those of the tree that are marked.";
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
  json["unsolved"] = unsolved_json(report);
  json["loops"] = Json::array();
  for (const Loop& loop : solution.loops) json["loops"].push_back(loop_json(report, loop));
  const ConsistentSet& set = solution.set;
  json["joint"]["source"] = report.joint ? "joint" : "pairs";
  json["joint"]["reason"] = report.why_not_joint;
  json["joint"]["certified"] = report.joint && set.certified;
  json["joint"]["cost"] = set.cost;
  json["joint"]["lower_bound"] = set.lower_bound;
  json["joint"]["pairwise_bound"] = set.pairwise_bound;
  json["joint"]["tree"] = tree_json(report);
  json["joint"]["apart"] = Json::array();
  for (const std::size_t sensor : report.apart) json["joint"]["apart"].push_back(report.names[sensor]);
  json["noise"] = solution.noise;
  return json;
}

std::string rig_text(const RigReport& report) {
  std::size_t width = 12;
  for (const RigPairAnswer& pair : report.solution.pairs)
    width = std::max(width, label_of(report, pair.a, pair.b).size());
  std::string text;
  for (const RigFinding& finding : report.findings)
    text +=
        fmt::format("{}{}\n              cure: {}\n", finding.certain ? "finding       " : "possible      ",
                    finding.message, finding.remedy);
  if (report.blamed) text += fmt::format("blamed        {}\n", report.names[*report.blamed]);
  text += unsolved_text(report) + loops_text(report) + goals_text(report) + "\n" + pairs_text(report, width) +
          set_text(report, width);
  text.pop_back();
  return text;
}

std::string contradiction(const RigReport& report) {
  if (!report.findings.empty() && report.findings.front().certain) return report.findings.front().message;
  for (const Calibration& calibration : report.pairs)
    if (calibration.verdict == Verdict::contradictory) return calibration.reason;
  return "A loop of three sensors does not close.";
}

std::vector<std::string> tree_remarks(const RigReport& report) {
  std::vector<std::string> lines;
  const ExtrinsicTree tree = tree_of(report);
  if (report.contradictory) lines.push_back("contradictory: " + contradiction(report) + " " + whose(tree));
  lines.push_back(report.joint ? "the tree is the joint answer of all pairs"
                               : "the tree is that of the most certain pairs: " + report.why_not_joint);
  if (!report.apart.empty())
    lines.push_back("not in the tree, as no answer connects them with the others: " + names_apart(report));
  for (const NamedExtrinsic& edge : tree.edges) {
    const auto is_of = [&](const RigPairAnswer& pair) {
      const std::string &a = report.names[pair.a], &b = report.names[pair.b];
      return (a == edge.parent && b == edge.child) || (a == edge.child && b == edge.parent);
    };
    const auto pair = std::find_if(report.solution.pairs.begin(), report.solution.pairs.end(), is_of);
    if (pair == report.solution.pairs.end()) continue;
    const auto index = static_cast<std::size_t>(pair - report.solution.pairs.begin());
    Calibration calibration = report.pairs[index];
    if (!edge.usable) {  // in the words of the rig
      calibration.verdict = std::max(calibration.verdict, Verdict::doubtful);
      calibration.reason = edge.reason;
      calibration.findings.clear();
    }
    for (const std::string& line : remarks(edge, calibration))
      lines.push_back(edge.parent + " -> " + edge.child + ": " + line);
  }
  return lines;
}

}  // namespace egocal::tools
