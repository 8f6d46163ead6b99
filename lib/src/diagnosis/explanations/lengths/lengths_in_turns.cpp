// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/lengths/lengths_in_turns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/motions/mount_fit.hpp"
#include "diagnosis/motions/standing_still.hpp"
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

/// As StreamOfTwoTimes::motion(), with a part s + k w of the lengths in place of times:
///   R_T' (R_a t + t_a - t) - t_b = (1 - R_b) y - t_b x x + (s + k w) l,
/// where l is the translation of b, as `side` measured it.
std::vector<LinearMotion> linear_motions(const Explained& given, Side side,
                                         const LengthsInTurnsOptions& options) {
  const Pose T = to_pose(given.fit.T);
  const Matrix3d R = T.rotation.toRotationMatrix();
  const double usual = usual_angle(given.motions);
  const std::size_t n = given.motions.all.size(), count = std::min(n, options.fit.most);
  std::vector<LinearMotion> result;
  for (std::size_t k = 0; usual > 0 && k < count; ++k) {
    const Motion& motion = given.motions.all[k * n / count];
    const Rotation R_b = to_pose(motion.b).rotation;
    const Matrix3d apart = Matrix3d::Identity() - R_b.toRotationMatrix();
    const Vector3d by_a = R.transpose() * (motion.R_a * T.translation + motion.t_a - T.translation);
    const double turning = std::min(0.5 * (motion.angle_a + motion.angle_b) / usual, options.most_turning);
    const Vector3d length = side == Side::b ? motion.t_b : by_a;
    LinearMotion here;
    here.rotation =
        rotation_log(T.rotation.conjugate() * to_pose(motion.a).rotation * T.rotation * R_b.conjugate());
    here.translation = by_a - motion.t_b;
    here.of_rotation << apart, Matrix3d::Zero(), Vector3d::Zero(), Vector3d::Zero();
    here.of_translation << -cross_matrix(motion.t_b), apart, length, turning * length;
    result.push_back(here);
  }
  return result;
}

LengthsInTurns by_lengths_of(const Explained& given, Side side, const LengthsInTurnsOptions& options) {
  const std::vector<LinearMotion> motions = linear_motions(given, side, options);
  LengthsInTurns found;
  if (motions.size() < options.least) return found;
  const MountFit fit(motions, options.fit);
  const MountNumbers x = fit.best(FreeNumbers::two);
  found.lost = x[of_turning];
  found.straight_on = 1 + x[of_all];
  found.stddev = fit.stddev(MountNumbers::Unit(of_turning));
  found.gain = fit.gain(fit.best(FreeNumbers::first), x);
  const Pose T = to_pose(given.fit.T);
  found.T_a_b = to_dual_quaternion(
      Pose{T.rotation * rotation_exp(x.head<3>()), T.translation + T.rotation * x.segment<3>(3)});
  return found;
}

/// Something else that lengths lost in turns may look like.
bool explains_lengths(const Finding& finding) {
  return (certain_of_either(finding) && finding.code != "scale" &&
          !finding.code.starts_with("undersampled_")) ||
         finding.code == "mount_moved" || finding.code == "scale_change" ||
         finding.code == "too_little_motion" || finding.code == "samples";
}

}  // namespace

double LengthsInTurns::sigmas() const {
  return stddev > 0 ? std::abs(lost) / stddev : 0;
}

std::optional<LengthsInTurns> lengths_in_turns(const Explained& given, const LengthsInTurnsOptions& options) {
  const LengthsInTurns by_b = by_lengths_of(given, Side::b, options),
                       by_a = by_lengths_of(given, Side::a, options);
  if (!(by_a.lost * by_b.lost > 0)) return std::nullopt;
  return std::abs(by_a.lost) < std::abs(by_b.lost) ? by_a : by_b;
}

void name_lengths_in_turns(const Evidence& evidence, const Answered& answered,
                           const DiagnosisOptions& options, std::vector<Finding>& findings,
                           const LengthsInTurnsOptions& tuning) {
  if (answered.problem.mode == Mode::planar ||
      std::any_of(findings.begin(), findings.end(), explains_lengths))
    return;
  const auto of_scale = [](const Finding& one) { return one.code == "scale"; };
  const bool has_scale = std::any_of(findings.begin(), findings.end(), of_scale);
  const Explanation& by = has_scale ? evidence.scaled : evidence.given;
  const std::optional<LengthsInTurns> found = lengths_in_turns(by.explained, tuning);
  if (!found || found->sigmas() < tuning.sigmas || std::abs(found->lost) < tuning.least_lost ||
      found->gain < tuning.least_gain || far_off(found->T_a_b, answered, options) < tuning.least_move)
    return;
  Finding finding;
  finding.code = "scale_change";
  finding.certain = true;
  finding.improvement = std::exp(found->gain);
  finding.T_a_b = to_pose(found->T_a_b);
  const char shorter = found->lost > 0 ? 'b' : 'a';
  say(finding,
      format("Against those of %s the lengths of %s are too short while it turns, by %.0f %% at its usual "
             "turning",
             mark(shorter == 'a' ? 'b' : 'a'), mark(shorter), 100 * std::abs(found->lost)),
      format("Take the lengths of %s from a sensor that does not slip in turns: a factor for the whole drive "
             "leaves a wrong answer that fits.",
             mark(shorter)),
      format(": wheels or tracks that slip, or an odometry that is lost in turns (%.0f standard deviations).",
             found->sigmas()));
  // one factor for the whole drive is a compromise, unless it is needed without turns as well
  if (std::abs(std::log(by.scale * found->straight_on)) < options.scale_check.least)
    std::erase_if(findings, of_scale);
  findings.insert(findings.begin(), std::move(finding));
}

}  // namespace egocal::detail
