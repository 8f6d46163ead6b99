// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "degrees.hpp"

namespace egocal::tools {

namespace {

std::string size_of(const Move& move) {
  const auto [turn, shift] = shown_change(move);
  if (turn == 0) return fmt::format("{:.1f} cm", 100 * shift);
  const std::string turned = fmt::format("{:.2f} deg", degrees * turn);
  return shift == 0 ? turned : fmt::format("{}, {:.1f} cm", turned, 100 * shift);
}

/// "camera", or "camera or lidar" where it is one of a pair.
std::string who(const RigReport& report, const std::optional<std::size_t>& sensor, std::size_t pair) {
  if (sensor) return report.names[*sensor];
  const RigPairAnswer& answer = report.solution.pairs[pair];
  return report.names[answer.a] + " or " + report.names[answer.b];
}

RigFinding moved(const RigReport& report, const RigMove& move, double begin) {
  RigFinding finding;
  finding.code = "mount_moved";
  finding.sensor = move.sensor;
  finding.time = begin + move.time;
  finding.move = move;
  const std::string name = who(report, move.sensor, move.pair);
  const std::string size = size_of(move.move);
  if (move.kind == MoveKind::creep) {
    finding.message = fmt::format("{} moves slowly from {:.1f} to {:.1f} s: {} in all.", name,
                                  begin + move.earliest, begin + move.latest, size);
    finding.remedy = "Fasten its mount; calibrate a shorter part of the drive.";
  } else {
    finding.message = fmt::format("{} moved at {:.1f} s (between {:.1f} and {:.1f} s): {}.", name,
                                  *finding.time, begin + move.earliest, begin + move.latest, size);
    finding.remedy = fmt::format("Calibrate the drive before and after {:.1f} s separately.", *finding.time);
  }
  return finding;
}

/// A finding of a pair that it is certain of, and which of its sensors it names.
struct PairFinding {
  std::size_t pair = 0;
  std::optional<std::size_t> sensor;
  const Finding* finding = nullptr;
};

/// Findings by code, without the _a and _b that name a sensor already.
std::map<std::string, std::vector<PairFinding>> findings_by_code(const RigReport& report) {
  std::map<std::string, std::vector<PairFinding>> result;
  for (std::size_t i = 0; i < report.pairs.size(); ++i)
    for (const Finding& finding : report.pairs[i].findings) {
      if (!finding.certain || finding.code == "mount_moved") continue;
      PairFinding found{i, std::nullopt, &finding};
      std::string code = finding.code;
      const RigPairAnswer& answer = report.solution.pairs[i];
      if (code.ends_with("_a")) found.sensor = answer.a;
      if (code.ends_with("_b")) found.sensor = answer.b;
      if (found.sensor) code.resize(code.size() - 2);
      result[code].push_back(found);
    }
  return result;
}

/// The one sensor that every finding names or has; empty where there is none or more than one.
std::optional<std::size_t> common_sensor(const RigReport& report, const std::vector<PairFinding>& of_code) {
  if (report.names.size() < 3) return std::nullopt;
  std::vector<std::size_t> common;
  for (std::size_t s = 0; s < report.names.size(); ++s)
    if (std::all_of(of_code.begin(), of_code.end(), [&](const PairFinding& found) {
          const RigPairAnswer& answer = report.solution.pairs[found.pair];
          return found.sensor ? *found.sensor == s : answer.a == s || answer.b == s;
        }))
      common.push_back(s);
  if (common.size() != 1) return std::nullopt;
  return common.front();
}

std::vector<RigFinding> of_pairs(const RigReport& report) {
  std::vector<RigFinding> findings;
  for (const auto& [code, of_code] : findings_by_code(report)) {
    const PairFinding& best =
        *std::max_element(of_code.begin(), of_code.end(), [](const PairFinding& i, const PairFinding& k) {
          return i.finding->improvement < k.finding->improvement;
        });
    RigFinding finding;
    finding.code = code;
    finding.sensor = common_sensor(report, of_code);
    finding.value = best.finding->value;
    finding.message = fmt::format("{}: {}", who(report, finding.sensor, best.pair), best.finding->message);
    finding.remedy = best.finding->remedy;
    findings.push_back(std::move(finding));
  }
  return findings;
}

/// Of both, what is the least likely by chance.
std::vector<RigMove> moves_of(std::size_t sensors, std::span<const RigPair> pairs,
                              std::span<const RigPair> single_steps) {
  const auto chance = [](const std::vector<RigMove>& moves) {
    double least = 1;
    for (const RigMove& move : moves) least = std::min(least, move.move.false_alarm);
    return least;
  };
  std::vector<RigMove> moves = find_rig_moves(sensors, pairs);
  if (single_steps.empty()) return moves;
  std::vector<RigMove> others = find_rig_moves(sensors, single_steps);
  return chance(others) < chance(moves) ? others : moves;
}

}  // namespace

void find_in_rig(std::span<const RigPair> pairs, std::span<const RigPair> single_steps, double begin,
                 RigReport& report) {
  std::vector<RigFinding> of_data = of_pairs(report);
  // wrong data of one sensor change its answers all through the drive: that is no moved mount
  if (of_data.empty())
    for (const RigMove& move : moves_of(report.names.size(), pairs, single_steps))
      report.findings.push_back(moved(report, move, begin));
  for (RigFinding& finding : of_data) report.findings.push_back(std::move(finding));
  for (const RigFinding& finding : report.findings)
    if (finding.sensor && !report.blamed) report.blamed = finding.sensor;
  const bool open = std::any_of(report.solution.loops.begin(), report.solution.loops.end(),
                                [](const Loop& loop) { return !loop.closed; });
  if (open && !report.blamed) report.blamed = report.solution.blamed;
  report.contradictory = report.contradictory || open || !report.findings.empty();
}

}  // namespace egocal::tools
