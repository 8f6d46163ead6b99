// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/mount.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "diagnosis/motions/correction.hpp"
#include "diagnosis/mount/mount_pairs.hpp"
#include "diagnosis/mount/step_across.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/moves/find_moves.hpp"

namespace egocal::detail {

namespace {

/// observable: of the answer; the size of a change in another direction is noise.
ShownChange known_change(Move move, const std::array<bool, 6>& observable) {
  for (std::size_t i = 0; i < 6; ++i)
    if (!observable[i]) move.stddev[i] = INFINITY;
  return shown_change(move);
}

std::string size_of(const Move& move, const std::array<bool, 6>& observable, bool metres) {
  const auto [turn, shift] = known_change(move, observable);
  std::string text;
  if (turn > 0) text = format("%.2f deg", turn * 180 / std::numbers::pi);
  if (shift > 0) text += (turn > 0 ? " and " : "") + length_in_words(shift, metres);
  return text;
}

/// begin: of the motions, on the clock of the finding [s].
void word(const Move& move, const Answered& answered, double begin, double long_interval, bool metres,
          Finding& finding) {
  const std::string size = size_of(move, answered.observability.observable, metres);
  const double from = begin + move.earliest, to = begin + move.latest;
  const Pose before = to_pose(move.before);
  const std::string answer =
      format("%.4f %.4f %.4f %s, w x y z %.5f %.5f %.5f %.5f", before.translation.x(), before.translation.y(),
             before.translation.z(), metres ? "m" : "units", before.rotation.w(), before.rotation.x(),
             before.rotation.y(), before.rotation.z());
  const char* alike = move.certain ? "" : " Noise that wanders for as long may look the same.";
  if (move.kind == MoveKind::creep) {
    finding.change = MountingChange::slowly;
    std::string claim = format("The mounting %s%s from %.1f to %.1f s after the start",
                               move.certain ? "creeps" : "seems to creep",
                               size.empty() ? "" : (": " + size).c_str(), from, to);
    const Eigen::Vector3d turned(move.change[3], move.change[4], move.change[5]);
    if (to > from && turned.allFinite())
      claim += format(", %.2g deg an hour", turned.norm() * 180 / std::numbers::pi * 3600 / (to - from));
    say(finding, std::move(claim), "Fasten the mounting; calibrate a shorter part of the drive.",
        ". At its begin the answer is " + answer + "." + alike);
    return;
  }
  finding.change = MountingChange::at_once;
  std::string claim = format("The mounting %s%s about %.1f s after the start",
                             move.certain ? "changed" : "seems to have changed",
                             size.empty() ? "" : (" by " + size).c_str(), *finding.time);
  if (to - from > long_interval) claim += format(" (between %.1f and %.1f s)", from, to);
  say(finding, std::move(claim),
      format("Calibrate the drive before and after %.1f s separately.", *finding.time),
      ". Before it the answer is " + answer + "." + alike);
}

/// Words the two findings of a mount that moved and fell back.
void word_falling_back(Finding& first, Finding& second) {
  const double moved = *first.time, back = *second.time;
  second.change = MountingChange::back;
  const std::string cure = format(
      "Fasten the mounting. Calibrate the parts before %.1f s, from then to %.1f s and after it "
      "separately.",
      moved, back);
  say(first, first.words.claim, cure, first.words.evidence);
  say(second, second.words.claim + format(", back to where it was before %.1f s", moved), cure,
      second.words.evidence);
}

using Strides = std::vector<std::vector<MotionPair>>;

MovesResult moves_of(const Strides& strides, const Answered& answered, const DiagnosisOptions& options) {
  MovesOptions moves;
  moves.false_alarms = options.mount.false_alarms;
  return find_moves_of_strides(strides, answered.problem, moves);
}

/// The motions without those of the last seconds.
Strides shown_before(Strides strides, const MountCheckOptions& mount) {
  for (std::vector<MotionPair>& pairs : strides) {
    const std::int64_t end = pairs.empty() ? 0 : pairs.back().end_us - to_microseconds(mount.shown_before);
    std::erase_if(pairs, [end](const MotionPair& pair) { return pair.end_us > end; });
  }
  return strides;
}

/// The moves that the motions show without those of the last seconds, too. Times of moves are counted from
/// the first motion of the stride that answers.
void keep_those_shown_before(const Strides& strides, const Answered& answered,
                             const DiagnosisOptions& options, MovesResult& result) {
  const MountCheckOptions& mount = options.mount;
  const Strides before = shown_before(strides, mount);
  const MovesResult earlier = moves_of(before, answered, options);
  const auto begin_us = [](const std::vector<MotionPair>& pairs) {
    return pairs.empty() ? 0 : pairs.front().begin_us;
  };
  const double later = to_seconds(begin_us(strides[result.stride]) - begin_us(before[earlier.stride]));
  std::erase_if(result.moves, [&](const Move& move) {
    return std::none_of(earlier.moves.begin(), earlier.moves.end(), [&](const Move& other) {
      return later + move.earliest <= std::max(other.latest, other.time + mount.same_time) &&
             later + move.latest >= std::min(other.earliest, other.time - mount.same_time);
    });
  });
}

/// Chance of the strongest evidence, or the chance without the motions of the last seconds where that is
/// larger.
double lasting_chance(const Strides& strides, const Answered& answered, const DiagnosisOptions& options,
                      double chance) {
  const MountCheckOptions& mount = options.mount;
  if (!(mount.shown_before > 0) || !(chance < mount.contradicting_times)) return chance;
  return std::max(chance, moves_of(shown_before(strides, mount), answered, options).chance);
}

std::int64_t begin_of(const Strides& strides, const MovesResult& result) {
  return strides[result.stride].front().begin_us;
}

/// The motions without those in the seconds around moves.
Strides without_those_around(Strides strides, std::int64_t begin_us, const std::vector<Move>& moves) {
  for (const Move& move : moves) {
    const std::int64_t left_us = begin_us + to_microseconds(move.time - CorrectionOptions{}.seconds),
                       right_us = begin_us + to_microseconds(move.time + CorrectionOptions{}.seconds);
    for (std::vector<MotionPair>& pairs : strides)
      std::erase_if(
          pairs, [&](const MotionPair& pair) { return pair.end_us > left_us && pair.begin_us < right_us; });
  }
  return strides;
}

/// Removes moves that are corrections of an odometry. Their motions are left out, and moves are looked for
/// again: motions of a correction change what is found near it.
void leave_out_corrections(Strides& strides, const Answered& answered, const DiagnosisOptions& options,
                           MovesResult& result) {
  constexpr int most_rounds = 3;  // limit on time
  const auto creeps = [](const Move& move) { return move.kind == MoveKind::creep; };
  for (int round = 0; round < most_rounds && !result.moves.empty(); ++round) {
    std::vector<Move> bumps = result.moves;
    std::erase_if(bumps, creeps);
    const bool creep = bumps.size() < result.moves.size();
    const std::vector<Move> kept =
        creep ? bumps : without_corrections(strides[result.stride], answered.problem, bumps);
    // what creeps beside a correction may be its rest: it is looked for again without all bumps
    std::vector<Move> left_out = bumps;
    if (!creep)
      std::erase_if(left_out, [&](const Move& move) {
        return std::any_of(kept.begin(), kept.end(),
                           [&](const Move& other) { return other.time == move.time; });
      });
    if (left_out.empty()) return;
    Strides others = without_those_around(strides, begin_of(strides, result), left_out);
    MovesResult without = moves_of(others, answered, options);
    if (creep && !without.moves.empty()) return;
    strides = std::move(others);
    result = std::move(without);
    if (options.mount.shown_before > 0) keep_those_shown_before(strides, answered, options, result);
  }
}

/// Removes moves of which the motions across their time show nothing; where noise hides it, or a mount would
/// have slid for seconds, they are uncertain.
void remove_those_not_shown(const Instants& instants, const PoseReading& reading, double begin,
                            const MotionSampleOptions& motions, std::vector<Move>& moves) {
  std::vector<Move> shown;
  for (Move& move : moves) {
    const StepShown across = step_across(instants, reading, move, begin, motions);
    if (across == StepShown::no) continue;
    if (across != StepShown::yes && move.false_alarm > StepOptions().evident) {
      if (across == StepShown::not_at_once) continue;
      move.certain = false;
    }
    shown.push_back(std::move(move));
  }
  moves = std::move(shown);
}

}  // namespace

MovedMount moved_mount(const Instants& instants, const Answered& answered, const DiagnosisOptions& options,
                       const PoseReading& reading) {
  Strides strides = strides_of(instants, answered, options, reading);
  MovesResult result = moves_of(strides, answered, options);
  if (result.moves.empty()) return {{}, lasting_chance(strides, answered, options, result.chance)};
  if (options.mount.shown_before > 0) keep_those_shown_before(strides, answered, options, result);
  leave_out_corrections(strides, answered, options, result);
  if (!result.moves.empty())
    remove_those_not_shown(instants, reading, to_seconds(begin_of(strides, result)), options.motions,
                           result.moves);
  // what is left without a correction may still contradict
  const double left = result.moves.empty() ? lasting_chance(strides, answered, options, result.chance) : 1;
  // as large as odometry errs, where the answer is known at all
  std::erase_if(result.moves, [&](const Move& move) {
    const auto [turn, shift] = known_change(move, answered.observability.observable);
    const MovesOptions least;
    return turn > 0 && turn < least.least_rotation && shift < least.least_translation;
  });
  if (result.moves.empty()) return {{}, left};
  std::vector<Finding> findings;
  const double begin = to_seconds(begin_of(strides, result));
  for (const Move& move : result.moves) {
    Finding finding;
    finding.code = "mount_moved";
    finding.certain = move.certain;
    finding.time = begin + move.time;
    finding.T_a_b = to_pose(move.after);
    word(move, answered, begin, options.mount.long_interval, options.unit == LengthUnit::metres, finding);
    findings.push_back(std::move(finding));
  }
  for (std::size_t k = 1; k < result.moves.size(); ++k)
    if (falls_back(result.moves[k - 1], result.moves[k])) word_falling_back(findings[k - 1], findings[k]);
  return {std::move(findings), 1};
}

std::optional<Finding> contradicting_times(double chance, const DiagnosisOptions& options) {
  if (!(chance < options.mount.contradicting_times)) return std::nullopt;
  Finding finding;
  finding.code = "mount_moved";
  finding.message = format(
      "Motions of different times contradict each other (by chance in one of %.0e drives): the mounting "
      "moved, or a stream changed, at times that are not clear.",
      1 / std::max(chance, 1e-300));
  finding.remedy = "Calibrate parts of the drive separately, and compare their answers.";
  return finding;
}

bool one_move(const std::vector<Finding>& moves) {
  return moves.size() == 1 || (moves.size() == 2 && moves[1].change == MountingChange::back);
}

}  // namespace egocal::detail
