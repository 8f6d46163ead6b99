// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/turning/wandering_headings.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/times/moved_answer.hpp"
#include "diagnosis/streams/turning_axis.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/statistics/median.hpp"
#include "linear_algebra/cross_matrix.hpp"
#include "linear_algebra/normal_equations.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Rows = Eigen::Matrix<double, 3, 6>;

/// What a motion leaves, what turn and shift of the mounting explain of it, and a turn of the positions
/// [rad].
struct HeadingMotion {
  Rows of_rotation, of_translation;
  Vector3d rotation, translation, of_heading;
};

std::vector<HeadingMotion> heading_motions(const Explained& given) {
  const Pose T = to_pose(given.fit.T);
  const Matrix3d R = T.rotation.toRotationMatrix();
  const Vector3d axis = turning_axis(given.motions, Side::b).axis;
  std::vector<HeadingMotion> result;
  for (const Motion& motion : given.motions.all) {
    const Rotation R_b = to_pose(motion.b).rotation;
    const Matrix3d apart = Matrix3d::Identity() - R_b.toRotationMatrix();
    HeadingMotion here;
    here.rotation =
        rotation_log(T.rotation.conjugate() * to_pose(motion.a).rotation * T.rotation * R_b.conjugate());
    here.translation = R.transpose() * (motion.R_a * T.translation + motion.t_a - T.translation) - motion.t_b;
    here.of_rotation << apart, Matrix3d::Zero();
    here.of_translation << -cross_matrix(motion.t_b), apart;
    here.of_heading = axis.cross(motion.t_b);
    result.push_back(here);
  }
  return result;
}

/// The mounting of the drive by reweighted linear least squares.
class MountOfDrive {
 public:
  MountOfDrive(const std::vector<HeadingMotion>& motions, const WanderingHeadingsOptions& options)
      : motions_(motions), weights_(motions.size(), 1.0) {
    measure();
    for (int round = 0; round < options.rounds; ++round) {
      x_ = solved([](const HeadingMotion& motion) { return motion.rotation; },
                  [](const HeadingMotion& motion) { return motion.translation; });
      measure();
      for (std::size_t i = 0; i < motions_.size(); ++i) {
        const double w = 1 / (1 + square(motions_[i]) / options.outlier);
        weights_[i] = w * w;
      }
    }
  }
  const Vector6d& mounting() const { return x_; }
  /// Change of the mounting where all positions are turned [per rad].
  Vector6d per_heading() const {
    return solved([](const HeadingMotion&) { return Vector3d(Vector3d::Zero()); },
                  [](const HeadingMotion& motion) { return motion.of_heading; });
  }
  double weight(std::size_t i) const { return weights_[i]; }
  Vector3d left(std::size_t i) const { return motions_[i].translation - motions_[i].of_translation * x_; }

 private:
  double square(const HeadingMotion& motion) const {
    return 0.5 * ((motion.rotation - motion.of_rotation * x_).squaredNorm() / rotation_ +
                  (motion.translation - motion.of_translation * x_).squaredNorm() / translation_);
  }
  void measure() {
    constexpr double rounding = 1e-16;  // eight digits of a pose, squared
    std::vector<double> rotations, translations;
    for (const HeadingMotion& motion : motions_) {
      rotations.push_back((motion.rotation - motion.of_rotation * x_).squaredNorm());
      translations.push_back((motion.translation - motion.of_translation * x_).squaredNorm());
    }
    rotation_ = std::max(median(std::move(rotations)), rounding);
    translation_ = std::max(median(std::move(translations)), rounding);
  }
  template <class RotationLeft, class TranslationLeft>
  Vector6d solved(RotationLeft rotation_left, TranslationLeft translation_left) const {
    Matrix6d sum = Matrix6d::Zero();
    Vector6d right = Vector6d::Zero();
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      const HeadingMotion& motion = motions_[i];
      add_square(sum, weights_[i] / rotation_, motion.of_rotation);
      add_square(sum, weights_[i] / translation_, motion.of_translation);
      add_product(right, weights_[i] / rotation_, motion.of_rotation, Vector3d(rotation_left(motion)));
      add_product(right, weights_[i] / translation_, motion.of_translation,
                  Vector3d(translation_left(motion)));
    }
    return solve_in_units(sum, right);
  }

  const std::vector<HeadingMotion>& motions_;
  std::vector<double> weights_;
  Vector6d x_ = Vector6d::Zero();
  double rotation_ = 1, translation_ = 1;  ///< median squares [rad^2, m^2]
};

/// Heading of a part of the drive [rad], and its weight.
struct PartHeading {
  double heading = 0, weight = 0;
};

/// Of the parts that move, in their order.
std::vector<PartHeading> headings_of_parts(const std::vector<HeadingMotion>& motions,
                                           const MountOfDrive& mount,
                                           const WanderingHeadingsOptions& options) {
  std::vector<PartHeading> parts(options.parts);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    PartHeading& part = parts[i * options.parts / motions.size()];
    part.heading += mount.weight(i) * motions[i].of_heading.dot(mount.left(i));
    part.weight += mount.weight(i) * motions[i].of_heading.squaredNorm();
  }
  std::vector<double> weights;
  for (const PartHeading& part : parts) weights.push_back(part.weight);
  const double least = options.least_weight * median(std::move(weights));
  std::erase_if(parts, [least](const PartHeading& part) { return !(part.weight > least); });
  for (PartHeading& part : parts) part.heading /= part.weight;
  return parts;
}

/// What contradicts the streams otherwise; a drift at a constant rate is beside it.
bool explains_wandering(const Finding& finding) {
  const bool drift = finding.code.starts_with("turning_drift_");
  return (certain_of_either(finding) && !drift && !finding.code.starts_with("undersampled_") &&
          finding.code != "clock_offset") ||
         finding.code == "too_little_motion" || finding.code == "samples";
}

Finding worded_wandering(char which, const WanderingHeadings& found, const Answered& answered) {
  Finding finding;
  finding.code = std::string("turning_drift_") + which;
  finding.T_a_b = to_pose(frame_a_moved(answered.T_a_b, found.moved));
  say(finding,
      format("The rotations of %s may turn away from its positions and back, by up to %.2g deg", mark(which),
             std::abs(found.most) * degrees_per_radian),
      format("Take rotations and positions of %s from one source, or the heading from one that does not "
             "drift.",
             mark(which)),
      ": the motions of each part of the drive agree, with an answer that changes slowly from part to part. "
      "A gyroscope whose bias wanders does that beside positions of another sensor; a mount that creeps "
      "looks the same.");
  return finding;
}

}  // namespace

std::optional<WanderingHeadings> wandering_headings(const Explained& given,
                                                    const WanderingHeadingsOptions& options) {
  if (given.motions.all.size() < options.least) return std::nullopt;
  const std::vector<HeadingMotion> motions = heading_motions(given);
  const MountOfDrive mount(motions, options);
  const std::vector<PartHeading> parts = headings_of_parts(motions, mount, options);
  if (parts.size() < options.least_parts) return std::nullopt;
  double weight = 0, mean = 0;
  for (const PartHeading& part : parts) {
    weight += part.weight;
    mean += part.weight * part.heading;
  }
  mean /= weight;
  WanderingHeadings found;
  double squares = 0, steps = 0, weight_of_steps = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double away = parts[i].heading - mean;
    squares += parts[i].weight * away * away / weight;
    if (std::abs(away) > std::abs(found.most)) found.most = away;
    if (i == 0) continue;
    const double step_weight = std::min(parts[i].weight, parts[i - 1].weight);
    steps += step_weight * std::pow(parts[i].heading - parts[i - 1].heading, 2);
    weight_of_steps += step_weight;
  }
  if (!(squares > 0)) return std::nullopt;
  found.unevenness = steps / weight_of_steps / squares;
  const Pose T = to_pose(given.fit.T);
  const auto moved_by = [&T](const Vector6d& x) {
    return to_dual_quaternion(
        Pose{T.rotation * rotation_exp(x.head<3>()), T.translation + T.rotation * x.tail<3>()});
  };
  found.moved = frame_a_difference(moved_by(mount.mounting()),
                                   moved_by(mount.mounting() + found.most * mount.per_heading()));
  return found;
}

void name_wandering_headings(const Evidence& evidence, const DiagnosisOptions& options, Answered& answered,
                             Diagnosis& result, const WanderingHeadingsOptions& wandering) {
  std::vector<Finding>& findings = result.findings;
  if (std::any_of(findings.begin(), findings.end(), explains_wandering)) return;
  std::optional<WanderingHeadings> found = wandering_headings(evidence.given.explained, wandering);
  if (!found || found->unevenness > wandering.most_uneven) return;
  found->moved = in_known_directions(found->moved, answered.observability);
  if (!matters(found->moved, answered, options, wandering.least_move, wandering.matters)) return;
  const bool named = std::any_of(findings.begin(), findings.end(), [](const Finding& one) {
    return one.code.starts_with("turning_drift_") || one.code == "mount_moved";
  });
  if (!named)
    for (const char which : {'b', 'a'}) findings.push_back(worded_wandering(which, *found, answered));
  widen_by(found->moved, answered, result);
}

}  // namespace egocal::detail
