// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig/rig_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "egocal/degrees.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/rig/rig_moves.hpp"
#include "offline/rig/rig_wording.hpp"
#include "offline/rig/unusable.hpp"

namespace egocal::tools {

namespace {

std::string size_of(const Move& move) {
  const auto [turn, shift] = shown_change(move);
  if (turn == 0) return fmt::format("{:.1f} cm", 100 * shift);
  const std::string turned = fmt::format("{:.2f} deg", degrees_per_radian * turn);
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
  finding.pair = move.pair;
  finding.pairs = {move.pair};
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

/// A finding of a pair, and which of its sensors it names.
struct PairFinding {
  std::size_t pair = 0;
  std::optional<std::size_t> sensor;
  const Finding* finding = nullptr;
};

using PairFindings = std::vector<PairFinding>;

/// The certain or the uncertain findings by code, without the _a and _b that name a sensor already.
std::map<std::string, PairFindings> findings_by_code(const RigReport& report, bool certain) {
  std::map<std::string, PairFindings> result;
  for (std::size_t i = 0; i < report.pairs.size(); ++i)
    for (const Finding& finding : report.pairs[i].findings) {
      if (certain_of_either(finding) != certain) continue;
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

/// Whether the streams are right in spite of findings of this code (docs/findings.md). They say how well an
/// answer is known, not that a sensor is wrong.
bool leaves_the_answer_right(const std::string& code) {
  return code == "undersampled" || code == "frozen" || code == "too_little_motion";
}

/// Whether a finding of held values is why the pair is doubtful, or nothing else is. They leave most answers
/// right.
bool is_the_reason(const Calibration& pair, const Finding& finding) {
  return pair.reason == finding.message ||
         std::none_of(pair.findings.begin(), pair.findings.end(), [&pair](const Finding& other) {
           return other.message == pair.reason || other.code == "mount_moved";
         });
}

/// Whether a pair that shows this finding should not be used as it is.
bool makes_bad(const RigReport& report, const PairFinding& found) {
  const Calibration& pair = report.pairs[found.pair];
  std::string code = found.finding->code;
  if (found.sensor) code.resize(code.size() - 2);
  return !leaves_the_answer_right(code) && pair.verdict >= Verdict::doubtful &&
         (code != "held" || is_the_reason(pair, *found.finding));
}

/// Whether findings of this code are of the pair. A wrong nominal value is a fault of what was given for the
/// pair: no sensor has it, whatever pairs show it.
bool is_of_the_pair(const std::string& code) {
  return code == "nominal";
}

/// Whether a finding is of this sensor, or may be.
bool may_be_of(const RigReport& report, const PairFinding& found, std::size_t sensor) {
  const RigPairAnswer& answer = report.solution.pairs[found.pair];
  return found.sensor ? *found.sensor == sensor : answer.a == sensor || answer.b == sensor;
}

/// The one sensor that the findings of every pair name or may mean; a pair may name either of its sensors, by
/// two findings. Empty where there is none or more than one.
std::optional<std::size_t> common_sensor(const RigReport& report, const PairFindings& of_code) {
  if (report.names.size() < 3) return std::nullopt;
  std::vector<std::size_t> common;
  for (std::size_t s = 0; s < report.names.size(); ++s)
    if (std::all_of(of_code.begin(), of_code.end(), [&](const PairFinding& of_pair) {
          return std::any_of(of_code.begin(), of_code.end(), [&](const PairFinding& found) {
            return found.pair == of_pair.pair && may_be_of(report, found, s);
          });
        }))
      common.push_back(s);
  if (common.size() != 1) return std::nullopt;
  return common.front();
}

/// The finding with the largest improvement among those that may be of this sensor; sensor empty: among all.
const PairFinding& best_of(const RigReport& report, const PairFindings& of_code,
                           std::optional<std::size_t> sensor) {
  const PairFinding* best = nullptr;
  for (const PairFinding& found : of_code)
    if ((!sensor || may_be_of(report, found, *sensor)) &&
        (!best || best->finding->improvement < found.finding->improvement))
      best = &found;
  return *best;
}

/// The rig's finding from the findings of one code that its pairs have, in the words of the rig.
RigFinding of_pairs(const RigReport& report, const std::string& code, const PairFindings& of_code,
                    const RigRequest& request, const RigSettings& settings) {
  RigFinding finding;
  finding.code = code;
  if (!is_of_the_pair(code)) finding.sensor = common_sensor(report, of_code);
  const PairFinding& best = best_of(report, of_code, finding.sensor);
  finding.pair = best.pair;
  for (const PairFinding& found : of_code)
    if (makes_bad(report, found)) finding.pairs.push_back(found.pair);
  const bool several = std::any_of(of_code.begin(), of_code.end(),
                                   [&](const PairFinding& found) { return found.pair != best.pair; });
  finding.certain = best.finding->certain || (certain_of_either(*best.finding) && finding.sensor && several);
  const RigPairAnswer& answer = report.solution.pairs[best.pair];
  RigWords words;
  words.rig = request.rig;
  words.offset_found = request.calibration.estimate_time_offset;
  words.name_a = report.names[answer.a];
  words.name_b = report.names[answer.b];
  words.scale_a = settings.scales[answer.a];
  words.scale_b = settings.scales[answer.b];
  const auto listed =
      std::find_if(settings.pairs.begin(), settings.pairs.end(),
                   [&](const RigPairSettings& pair) { return pair.a == answer.a && pair.b == answer.b; });
  words.listed_turned = listed != settings.pairs.end() && listed->turned;
  words.time_offset = report.pairs[best.pair].time_offset_applied;
  std::optional<bool> of_b;
  if (finding.sensor) of_b = *finding.sensor == answer.b;
  word_for_rig(*best.finding, of_b, words, finding);
  std::string of =
      is_of_the_pair(code) ? words.name_a + ", " + words.name_b : who(report, finding.sensor, best.pair);
  if (is_of_the_pair(code) && words.listed_turned)
    of += fmt::format(" (listed as {}, {}; in the axes of {})", words.name_b, words.name_a, words.name_a);
  finding.message = fmt::format("{}: {}", of, finding.message);
  return finding;
}

/// A move of which the motions that all sensors share show nothing.
RigFinding moved_by_pairs(const RigReport& report, const PairFindings& of_move, double begin) {
  const PairFinding& first = of_move.front();
  RigFinding finding;
  finding.code = "mount_moved";
  finding.sensor = of_move.size() > 1 ? common_sensor(report, of_move) : std::nullopt;
  finding.pair = first.pair;
  for (const PairFinding& found : of_move) finding.pairs.push_back(found.pair);
  finding.time = begin + first.finding->time.value_or(0);
  finding.message = fmt::format("{}: {}", who(report, finding.sensor, first.pair), first.finding->message);
  finding.remedy = first.finding->remedy;
  return finding;
}

/// A mount that was moved between two drives: which pairs of them show it.
using ShownByPairs = std::vector<const MountsOfPair*>;

/// The pair that shows the largest move of those.
const MountsOfPair& largest_of(const ShownByPairs& shown) {
  return **std::max_element(shown.begin(), shown.end(),
                            [](const MountsOfPair* one, const MountsOfPair* other) {
                              return std::pair(one->differ.shown.turn, one->differ.shown.shift) <
                                     std::pair(other->differ.shown.turn, other->differ.shown.shift);
                            });
}

/// Mounts that were moved between drives, and whose they are.
std::vector<RigFinding> moved_between_drives(const RigReport& report) {
  std::map<std::pair<std::size_t, std::size_t>, ShownByPairs> by_drives;
  for (const MountsOfPair& mounts : report.mounts)
    by_drives[{mounts.differ.first, mounts.differ.second}].push_back(&mounts);
  std::vector<RigFinding> findings;
  for (const auto& [drives, shown] : by_drives) {
    RigFinding finding;
    finding.code = "mount_moved";
    PairFindings of_pairs;
    for (const MountsOfPair* mounts : shown) {
      finding.pairs.push_back(mounts->pair);
      of_pairs.push_back({mounts->pair, std::nullopt, &mounts->differ.finding});
    }
    if (shown.size() > 1) finding.sensor = common_sensor(report, of_pairs);
    const MountsOfPair& largest = largest_of(shown);
    finding.pair = largest.pair;
    finding.message =
        fmt::format("{}: {}", who(report, finding.sensor, finding.pair), largest.differ.finding.message);
    finding.remedy = largest.differ.finding.remedy;
    findings.push_back(std::move(finding));
  }
  return findings;
}

bool is_between_drives(const RigReport& report, const PairFinding& found) {
  return std::any_of(report.mounts.begin(), report.mounts.end(), [&](const MountsOfPair& mounts) {
    return mounts.pair == found.pair && mounts.differ.finding.message == found.finding->message;
  });
}

/// Moves that the diagnosis of some pair shows, and whose they are.
std::vector<RigFinding> moves_in_rig(const RigReport& report, const PairFindings& of_moves,
                                     const CommonMotions& motions,
                                     const std::vector<Trajectory>& trajectories) {
  const std::int64_t start_us = trajectories.front().front().time_us;
  // since the first pose of the rig's first sensor [s]
  const auto time_of = [&](const PairFinding& found) {
    const std::size_t a = report.solution.pairs[found.pair].a;
    return to_seconds(trajectories[a].front().time_us - start_us) + found.finding->time.value_or(0);
  };
  std::vector<RigMove> moves;
  std::vector<ShownMove> shown;
  for (const PairFinding& found : of_moves)
    if (found.finding->time) shown.push_back({found.pair, time_of(found) - motions.begin});
  if (!shown.empty() && !motions.pairs.empty() && report.unsolved.empty()) {
    const auto chance = [](const std::vector<RigMove>& found) {
      double least = 1;
      for (const RigMove& move : found) least = std::min(least, move.move.false_alarm);
      return least;
    };
    moves = find_rig_moves(report.names.size(), motions.pairs, shown);
    if (!motions.single_steps.empty()) {
      std::vector<RigMove> others = find_rig_moves(report.names.size(), motions.single_steps, shown);
      if (chance(others) < chance(moves)) moves = std::move(others);
    }
  }
  std::vector<RigFinding> findings;
  for (const RigMove& move : moves) findings.push_back(moved(report, move, motions.begin));
  // what is left, the findings of one time as one
  PairFindings left;
  const double same_time = RigMovesOptions{}.same_time;
  for (const PairFinding& found : of_moves) {
    const double time = time_of(found);
    if (std::none_of(moves.begin(), moves.end(), [&](const RigMove& move) {
          return motions.begin + move.earliest - same_time <= time &&
                 time <= motions.begin + move.latest + same_time;
        }))
      left.push_back(found);
  }
  while (!left.empty()) {
    const double time = time_of(left.front());
    const auto is_same = [&](const PairFinding& found) {
      return std::abs(time_of(found) - time) <= 2 * same_time;
    };
    PairFindings same;
    std::copy_if(left.begin(), left.end(), std::back_inserter(same), is_same);
    std::erase_if(left, is_same);
    findings.push_back(moved_by_pairs(report, same, time - same.front().finding->time.value_or(0)));
  }
  return findings;
}

}  // namespace

void find_in_rig(const CommonMotions& motions, const std::vector<Trajectory>& trajectories,
                 const RigRequest& request, const RigSettings& settings, RigReport& report) {
  const std::map<std::string, PairFindings> by_code = findings_by_code(report, true);
  std::vector<RigFinding> bad, others;
  for (const auto& [code, of_code] : by_code) {
    if (code == "mount_moved") {
      PairFindings in_drives = of_code;
      std::erase_if(in_drives, [&](const PairFinding& found) { return is_between_drives(report, found); });
      for (RigFinding& move : moved_between_drives(report)) bad.push_back(std::move(move));
      for (RigFinding& move : moves_in_rig(report, in_drives, motions, trajectories))
        bad.push_back(std::move(move));
      continue;
    }
    if (is_of_the_pair(code)) {
      for (const PairFinding& found : of_code)
        (makes_bad(report, found) ? bad : others)
            .push_back(of_pairs(report, code, {found}, request, settings));
      continue;
    }
    const bool is_bad = std::any_of(of_code.begin(), of_code.end(),
                                    [&](const PairFinding& found) { return makes_bad(report, found); });
    (is_bad ? bad : others).push_back(of_pairs(report, code, of_code, request, settings));
  }
  for (const RigFinding& finding : bad)
    if (finding.sensor && !report.blamed) report.blamed = finding.sensor;
  const bool open = std::any_of(report.solution.loops.begin(), report.solution.loops.end(), is_open);
  if (open && !report.blamed) report.blamed = report.solution.blamed;
  report.contradictory = report.contradictory || open || !bad.empty();
  for (std::size_t i = 0; i < report.pairs.size(); ++i)
    report.unusable.push_back(why_unusable(report, bad, i));
  report.findings = std::move(bad);
  for (RigFinding& finding : others) report.findings.push_back(std::move(finding));
  for (const auto& [code, of_code] : findings_by_code(report, false))
    if (!by_code.contains(code))
      report.findings.push_back(of_pairs(report, code, of_code, request, settings));
}

}  // namespace egocal::tools
