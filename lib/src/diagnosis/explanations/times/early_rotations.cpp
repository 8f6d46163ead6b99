// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/early_rotations.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/times/moved_answer.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

bool shows_two_times(const EarlyRotations& found, const EarlyRotationsOptions& early) {
  return found.sigmas() > early.sigmas && found.gain > early.least_gain &&
         std::abs(found.of_rotations) > early.sigmas * found.of_rotations_stddev &&
         std::abs(found.of_rotations - found.seconds) <
             early.most_of_positions * std::abs(found.of_rotations);
}

/// How far two times move the answer, in the directions that are known.
Vector6d moved_by_two_times(const EarlyRotations& found, const Answered& answered) {
  return in_known_directions(frame_a_difference(found.T_a_b_as_given, found.T_a_b), answered.observability);
}

/// The rotations of `side` are early, so that its positions look late.
Finding worded_late_positions(const EarlyRotations& found, Side side, const Answered& answered) {
  const char which = side == Side::a ? 'a' : 'b', rest = side == Side::a ? 'b' : 'a';
  const double seconds = side == found.side ? found.seconds : -found.seconds;
  Finding finding;
  finding.code = std::string("late_positions_") + which;
  finding.improvement = std::exp(std::max(0.0, found.gain));
  finding.T_a_b = to_pose(frame_a_moved(answered.T_a_b, moved_by_two_times(found, answered)));
  finding.value = seconds;
  say(finding,
      format("The positions of %s are about %.2f s %s than its rotations", mark(which), std::abs(seconds),
             seconds > 0 ? "later" : "earlier"),
      format("Give positions and rotations of %s of the same times: no filter that smooths or delays one of "
             "them.",
             mark(which)),
      format(
          ", or those of %s are %s by as much, or one of the sensors is on a part that is steered or towed: "
          "the turns show it by %.0f standard deviations.",
          mark(rest), seconds > 0 ? "earlier" : "later", found.sigmas()));
  return finding;
}

/// A part that is steered turns into the curve before the vehicle does, one that is towed after it.
Finding worded_steered(const EarlyRotations& found, const Answered& answered) {
  const bool leads = found.seconds > 0;
  const char which = (found.side == Side::a) == leads ? 'a' : 'b';
  Finding finding;
  finding.code = "mount_moved";
  finding.improvement = std::exp(std::max(0.0, found.gain));
  finding.T_a_b = to_pose(frame_a_moved(answered.T_a_b, moved_by_two_times(found, answered)));
  say(finding,
      format(
          "%s may be on a part that is steered, or %s on one that is towed: the angle between them is about "
          "%.2f s times the turning rate",
          mark(which), mark(which == 'a' ? 'b' : 'a'), std::abs(found.seconds)),
      "Fasten both sensors to one rigid part, and record again.",
      ". The rotations of the first then look early by that time.");
  return finding;
}

/// Early rotations of the stream that explains more by them; empty where neither stream shows any.
std::optional<EarlyRotations> early_of_either(const Evidence& evidence, const EarlyRotationsOptions& early) {
  std::optional<EarlyRotations> found =
      early_rotations(evidence.instants, evidence.given.explained, Side::b, early);
  if (!found || found->sigmas() < early.first_look * early.sigmas) return std::nullopt;
  std::optional<EarlyRotations> other =
      early_rotations(evidence.instants, evidence.given.explained, Side::a, early);
  if (other && shows_two_times(*other, early) &&
      (!shows_two_times(*found, early) || other->gain > found->gain))
    found = other;
  return shows_two_times(*found, early) ? found : std::nullopt;
}

}  // namespace

bool explains_early(const Finding& finding, const DiagnosisOptions& options) {
  // it may be between the times of rotations and of positions; of a large one they would not be linear
  const bool small_offset = finding.code == "clock_offset" && finding.value &&
                            std::abs(*finding.value) <= options.clock_check.widest;
  return (certain_of_either(finding) && !finding.code.starts_with("undersampled_") && !small_offset) ||
         finding.code == "mount_moved" || finding.code == "scale_change" ||
         finding.code == "too_little_motion" || finding.code == "samples";
}

double EarlyRotations::sigmas() const {
  return stddev > 0 ? std::abs(seconds) / stddev : 0;
}

std::optional<EarlyRotations> early_rotations(const Instants& instants, const Explained& given, Side side,
                                              const EarlyRotationsOptions& early) {
  const StreamOfTwoTimes stream(instants, given, side, early.times);
  const std::vector<LinearMotion> motions = stream.motions(given, early.times.fit.most);
  if (motions.size() < early.least) return std::nullopt;
  const MountFit fit(motions, early.times.fit);
  const MountNumbers x = fit.best(FreeNumbers::two);
  const MountNumbers rotations = MountNumbers::Unit(time_of_rotations),
                     apart = rotations - MountNumbers::Unit(time_of_positions);
  EarlyRotations found;
  found.side = side;
  found.seconds = apart.dot(x);
  found.stddev = fit.stddev(apart);
  found.of_rotations = rotations.dot(x);
  found.of_rotations_stddev = fit.stddev(rotations);
  found.gain = fit.gain(fit.best(FreeNumbers::one_for_both), x);
  found.T_a_b = stream.T_a_b(x);
  found.T_a_b_as_given = stream.T_a_b(fit.best(FreeNumbers::none));
  return found;
}

void name_early_rotations(const Evidence& evidence, const DiagnosisOptions& options, Answered& answered,
                          Diagnosis& result, const EarlyRotationsOptions& early) {
  if (std::any_of(result.findings.begin(), result.findings.end(),
                  [&](const Finding& one) { return explains_early(one, options); }))
    return;
  const std::optional<EarlyRotations> found = early_of_either(evidence, early);
  if (!found) return;
  const Vector6d moved = moved_by_two_times(*found, answered);
  if (!matters(moved, answered, options, early.least_move, early.matters)) return;
  // filters delay, so the stream whose positions are late comes first
  const Side other = found->side == Side::a ? Side::b : Side::a,
             late = found->seconds > 0 ? found->side : other;
  const std::vector<Finding> findings{
      worded_late_positions(*found, late, answered),
      worded_late_positions(*found, late == Side::a ? Side::b : Side::a, answered),
      worded_steered(*found, answered)};
  // a clock between both
  std::erase_if(result.findings, [](const Finding& one) { return one.code == "clock_offset"; });
  result.findings.insert(result.findings.begin(), findings.begin(), findings.end());
  widen_by(moved, answered, result);
}

}  // namespace egocal::detail
