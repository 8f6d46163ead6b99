// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/lengths/lengths_in_turns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/explanations/times/moved_answer.hpp"
#include "diagnosis/motions/mount_fit.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "diagnosis/streams/turning_axis.hpp"
#include "diagnosis/verdict/far_off.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "linear_algebra/cross_matrix.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// places in MountNumbers of the numbers of the lengths
constexpr int of_all = first_number, of_turning = second_number;

/// How far a motion turns, in units of the usual angle, as it counts for the lengths.
class TurningOfMotions {
 public:
  TurningOfMotions(const Explained& given, TurnsThatCount turns, const LengthsInTurnsOptions& options)
      : turns_(turns),
        usual_(usual_angle(given.motions)),
        most_(turns == TurnsThatCount::side ? options.side_alone : options.most_turning) {
    if (turns == TurnsThatCount::all) return;
    axis_b_ = turning_axis(given.motions, Side::b).axis;
    axis_a_ = to_pose(given.fit.T).rotation * axis_b_;
  }
  bool any() const { return usual_ > 0; }
  double operator()(const Motion& motion) const {
    if (turns_ == TurnsThatCount::all)
      return std::min(0.5 * (motion.angle_a + motion.angle_b) / usual_, most_);
    const double about = 0.5 * (axis_a_.dot(rotation_log(to_pose(motion.a).rotation)) +
                                axis_b_.dot(rotation_log(to_pose(motion.b).rotation)));
    const double turned = std::clamp(about / usual_, -most_, most_);
    return turns_ == TurnsThatCount::side ? turned / most_ : turned;
  }

 private:
  TurnsThatCount turns_;
  double usual_, most_;
  Vector3d axis_a_ = Vector3d::Zero(), axis_b_ = Vector3d::Zero();
};

/// As StreamOfTwoTimes::motion(), with a part s + k w of the lengths in place of times:
///   R_T' (R_a t + t_a - t) - t_b = (1 - R_b) y - t_b x x + (s + k w) l,
/// where l is the translation of b, as `side` measured it.
std::vector<LinearMotion> linear_motions(const Explained& given, Side side, TurnsThatCount turns,
                                         const LengthsInTurnsOptions& options) {
  const Pose T = to_pose(given.fit.T);
  const Matrix3d R = T.rotation.toRotationMatrix();
  const TurningOfMotions turning(given, turns, options);
  const std::size_t n = given.motions.all.size(), count = std::min(n, options.fit.most);
  std::vector<LinearMotion> result;
  for (std::size_t k = 0; turning.any() && k < count; ++k) {
    const Motion& motion = given.motions.all[k * n / count];
    const Rotation R_b = to_pose(motion.b).rotation;
    const Matrix3d apart = Matrix3d::Identity() - R_b.toRotationMatrix();
    const Vector3d by_a = R.transpose() * (motion.R_a * T.translation + motion.t_a - T.translation);
    const Vector3d length = side == Side::b ? motion.t_b : by_a;
    LinearMotion here;
    here.rotation =
        rotation_log(T.rotation.conjugate() * to_pose(motion.a).rotation * T.rotation * R_b.conjugate());
    here.translation = by_a - motion.t_b;
    here.of_rotation << apart, Matrix3d::Zero(), Vector3d::Zero(), Vector3d::Zero();
    here.of_translation << -cross_matrix(motion.t_b), apart, length, turning(motion) * length;
    result.push_back(here);
  }
  return result;
}

LengthsInTurns by_lengths_of(const Explained& given, Side side, TurnsThatCount turns,
                             const LengthsInTurnsOptions& options) {
  const std::vector<LinearMotion> motions = linear_motions(given, side, turns, options);
  LengthsInTurns found;
  found.turns = turns;
  if (motions.size() < options.least) return found;
  const MountFit fit(motions, options.fit);
  const MountNumbers x = fit.best(FreeNumbers::two);
  found.lost = x[of_turning];
  found.straight_on = 1 + x[of_all];
  found.stddev = fit.stddev(MountNumbers::Unit(of_turning));
  found.gain = fit.gain(fit.best(FreeNumbers::first), x);
  const Pose T = to_pose(given.fit.T);
  const auto moved_by = [&T](const MountNumbers& numbers) {
    return to_dual_quaternion(Pose{T.rotation * rotation_exp(numbers.head<3>()),
                                   T.translation + T.rotation * numbers.segment<3>(3)});
  };
  found.T_a_b = moved_by(x);
  found.T_a_b_as_given = moved_by(fit.best(FreeNumbers::none));
  return found;
}

/// Something else that lengths lost in turns may look like.
bool explains_lengths(const Finding& finding) {
  return (certain_of_either(finding) && finding.code != "scale" &&
          !finding.code.starts_with("undersampled_")) ||
         finding.code == "mount_moved" || finding.code == "too_little_motion" || finding.code == "samples";
}

/// What turns are looked for in: motions that are short, where a side of them counts, as in longer ones a
/// vehicle turns to both.
Explained motions_for(TurnsThatCount turns, const Evidence& evidence, const Explanation& by,
                      const DiagnosisOptions& options, const LengthsInTurnsOptions& tuning) {
  const double instants = tuning.seconds_to_a_side / evidence.instants.period;
  if (turns == TurnsThatCount::all || !(instants < evidence.stride)) return by.explained;
  Motions motions = motions_of(evidence.instants, {}, {}, std::max(1, static_cast<int>(instants)),
                               tuning.fit.most, options.motions);
  if (by.scale != 1) motions = scaled(motions, by.scale);
  return {std::move(motions), by.explained.fit};
}

/// Whether the lengths are wrong in turns by far more than chance.
bool are_lost(const LengthsInTurns& found, const LengthsInTurnsOptions& tuning) {
  return found.sigmas() >= tuning.sigmas && std::abs(found.lost) >= tuning.least_lost;
}

/// Whether that explains the motions clearly better, and the answer is another one then.
bool explains_more(const LengthsInTurns& found, const Answered& answered, const DiagnosisOptions& options,
                   const LengthsInTurnsOptions& tuning) {
  return found.gain >= tuning.least_gain && far_off(found.T_a_b, answered, options) >= tuning.least_move;
}

void say_lost(const LengthsInTurns& found, Finding& finding) {
  const char shorter = found.lost > 0 ? 'b' : 'a';
  say(finding,
      format("Against those of %s the lengths of %s are too short while it turns, by %.0f %% at its usual "
             "turning",
             mark(shorter == 'a' ? 'b' : 'a'), mark(shorter), 100 * std::abs(found.lost)),
      format(
          "Take the lengths of %s from a sensor that does not slip in turns, and without a filter: a factor "
          "for the whole drive leaves a wrong answer that fits.",
          mark(shorter)),
      format(": wheels or tracks that slip, an odometry that is lost in turns, or positions that a filter "
             "smooths, which cuts corners (%.0f standard deviations).",
             found.sigmas()));
}

void say_lost_to_a_side(const LengthsInTurns& found, Finding& finding) {
  say(finding,
      format("Against those of {a} the lengths of {b} are too long in turns to one side and too short in "
             "those to the other, by %.0f %% %s",
             100 * std::abs(found.lost),
             found.turns == TurnsThatCount::side ? "each" : "at the usual turning"),
      "Calibrate the odometry of each of the two by itself, by circles to both sides, or take the lengths "
      "from another sensor: {a} may be the wrong one as well.",
      format(": an odometry of {b}, or of {a}, that is calibrated to one side (%.0f standard deviations). At "
             "a constant speed that looks like a sensor that sits further to a side.",
             found.sigmas()));
}

}  // namespace

double LengthsInTurns::sigmas() const {
  return stddev > 0 ? std::abs(lost) / stddev : 0;
}

std::optional<LengthsInTurns> lengths_in_turns(const Explained& given, TurnsThatCount turns,
                                               const LengthsInTurnsOptions& options) {
  const LengthsInTurns by_b = by_lengths_of(given, Side::b, turns, options),
                       by_a = by_lengths_of(given, Side::a, turns, options);
  if (!(by_a.lost * by_b.lost > 0)) return std::nullopt;
  return std::abs(by_a.lost) < std::abs(by_b.lost) ? by_a : by_b;
}

Vector6d name_lengths_in_turns(const Evidence& evidence, const Answered& answered,
                               const DiagnosisOptions& options, std::vector<Finding>& findings,
                               const LengthsInTurnsOptions& tuning) {
  Vector6d moved = Vector6d::Zero();
  if (answered.problem.mode == Mode::planar ||
      std::any_of(findings.begin(), findings.end(), explains_lengths))
    return moved;
  const auto of_scale = [](const Finding& one) { return one.code == "scale"; };
  const bool has_scale = std::any_of(findings.begin(), findings.end(), of_scale);
  const Explanation& by = has_scale ? evidence.scaled : evidence.given;
  std::optional<LengthsInTurns> found;
  for (const TurnsThatCount turns : {TurnsThatCount::all, TurnsThatCount::by_side, TurnsThatCount::side}) {
    const std::optional<LengthsInTurns> here =
        lengths_in_turns(motions_for(turns, evidence, by, options, tuning), turns, tuning);
    if (!here || !are_lost(*here, tuning) || (found && here->gain <= found->gain)) continue;
    const bool explains_little = turns != TurnsThatCount::all && !has_scale && here->gain < tuning.least_gain;
    if (explains_little || explains_more(*here, answered, options, tuning)) found = here;
  }
  if (!found) return moved;
  Finding finding;
  finding.code = "scale_change";
  finding.certain = explains_more(*found, answered, options, tuning);
  finding.improvement = std::exp(found->gain);
  finding.T_a_b = to_pose(found->T_a_b);
  // uncertain, as a certain one explains the streams: turns of a part of the drive to one side look like it
  const auto along_the_drive = [](const Finding& one) { return one.code == "scale_change"; };
  const auto other = std::find_if(findings.begin(), findings.end(), along_the_drive);
  if (other != findings.end() && !(finding.certain && finding.improvement > other->improvement)) return moved;
  if (!finding.certain) {
    const Vector6d change =
        in_known_directions(frame_a_difference(found->T_a_b_as_given, found->T_a_b), answered.observability);
    if (!matters(change, answered, options, tuning.least_move, tuning.matters)) return moved;
    finding.T_a_b = to_pose(frame_a_moved(answered.T_a_b, change));
    moved = change;
  }
  std::erase_if(findings, along_the_drive);
  if (found->turns == TurnsThatCount::all)
    say_lost(*found, finding);
  else
    say_lost_to_a_side(*found, finding);
  // one factor for the whole drive is a compromise, unless it is needed without turns as well
  if (std::abs(std::log(by.scale * found->straight_on)) < options.scale_check.least)
    std::erase_if(findings, of_scale);
  findings.insert(findings.begin(), std::move(finding));
  return moved;
}

}  // namespace egocal::detail
