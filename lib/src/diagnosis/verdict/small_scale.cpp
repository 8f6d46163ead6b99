// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/small_scale.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/goal/goal.hpp"
#include "diagnosis/verdict/besides.hpp"
#include "diagnosis/verdict/far_off.hpp"
#include "diagnosis/verdict/foreseen.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/directions.hpp"
#include "egocal/statistics/median.hpp"
#include "scale/joint_jackknife.hpp"
#include "statistics/distributions.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// The scale of b as the motions of an answer show it.
struct ScaleOfAnswer {
  double log_scale = 0;
  double stddev = INFINITY;         ///< of log_scale
  Vector6d per = Vector6d::Zero();  ///< change of the answer per change of log_scale [m, rad], frame a
  double sigmas() const { return std::abs(log_scale) / stddev; }
  /// Whether it is another one than one. right: what right odometries differ by.
  bool differs(double right, double significant, double where_larger) const {
    return sigmas() >= (std::abs(log_scale) < right ? significant : where_larger);
  }
  /// The one farthest from zero that these motions do not exclude. Beyond what right odometries differ by
  /// only what the motions themselves say.
  double farthest(double right) const {
    const double interval = two_sided_95 * stddev, size = std::abs(log_scale);
    return std::copysign(std::min(size + interval, std::max(right, size - interval)), log_scale);
  }
};

/// Instants that motions of the answer's length span: live fewer poses are kept than pairing has.
int steps_of(const Evidence& evidence, const Answered& answered) {
  const double kept = static_cast<double>(evidence.instants.size()),
               paired = static_cast<double>(answered.counts.synchronised);
  return std::max(1, static_cast<int>(std::lround(answered.stride * (paired > 0 ? kept / paired : 1))));
}

/// Motions of the answer's own length, in the directions that it is solved in; b's plane through its origin,
/// as its height is not scaled.
struct MotionsOfAnswer {
  Motions motions;
  DualQuaternion plane_a, plane_b, T;
  bool planar = false;

  MotionsOfAnswer(const Evidence& evidence, const Answered& answered, const MotionSampleOptions& options)
      : motions(motions_of(evidence.instants, {}, {}, steps_of(evidence, answered), options.most, options)),
        T(answered.T_a_b),
        planar(answered.problem.mode == Mode::planar) {
    if (!planar) return;
    GroundPlane through_b = answered.problem.plane_b;
    through_b.distance = 0;
    plane_a = plane_frame(answered.problem.plane_a);
    plane_b = plane_frame(through_b);
    T = planar_from_extrinsic(answered.T_a_b, plane_a, plane_b);
  }
  void add(const Motion& motion, ScaleStatistics& sum) const {
    if (planar)
      sum.add(planar_motion(motion.a, plane_a), planar_motion(motion.b, plane_b));
    else
      sum.add(motion.a, motion.b);
  }
  /// x y z roll pitch yaw of the frame that was solved in, in that of a.
  Vector6d in_frame_of_a(const Vector6d& x) const {
    if (!planar) return x;
    const Rotation R = to_pose(plane_a).rotation;
    Vector6d turned;
    turned << R * x.head<3>(), R * x.tail<3>();
    return turned;
  }
};

/// The statistics of consecutive parts of the drive, without outliers.
std::vector<ScaleStatistics> parts_of(const MotionsOfAnswer& of, const Answered& answered,
                                      std::size_t most_parts, const SmallScaleOptions& options) {
  const std::vector<double> squares = evaluated(of.motions, answered.T_a_b).squares;
  const double limit = options.most_residual * median(squares);
  const std::size_t n = squares.size(), count = std::min(most_parts, of.motions.blocks);
  std::vector<ScaleStatistics> parts(count);
  for (std::size_t i = 0; i < n; ++i)
    if (squares[i] <= limit) {
      ScaleStatistics& part = parts[i * count / n];
      of.add(of.motions.all[i], part);
    }
  for (ScaleStatistics& part : parts) part = with_scale_on_b(part);
  return parts;
}

/// Scale by one Newton step over scale and extrinsic from the answer, with the motions and weights of the
/// answer. Empty where there are too few motions.
std::optional<ScaleOfAnswer> scale_of_answer(const Evidence& evidence, const Answered& answered,
                                             const DiagnosisOptions& options,
                                             const SmallScaleOptions& small) {
  const MotionsOfAnswer of(evidence, answered, options.motions);
  if (of.motions.all.size() < options.motions.least) return std::nullopt;
  const std::vector<ScaleStatistics> parts = parts_of(of, answered, options.scale_check.blocks, small);
  const ScaleStatistics all = sum_blocks(parts);
  if (!(all.weight > 0)) return std::nullopt;
  // both translations may be noisy: the cost counts lengths in the mean of both units (ScaleNoise::both)
  constexpr double weight_slope = -1;
  const JointForm form(all,
                       {1, of.T, answered.problem.balance, weight_slope, all.weight, answered.problem.mode});
  const ScaleDerivatives joint = form.of(all);
  const ScaleDerivatives::OverScale over_scale = joint.over_scale();
  ScaleOfAnswer result;
  for (Eigen::Index i = 0; i < 6; ++i) result.per[i] = over_scale.sensitivity[static_cast<std::size_t>(i)];
  result.per = of.in_frame_of_a(result.per);
  if (!(over_scale.curvature > 0)) return result;  // the motions show no scale
  const Eigen::LDLT<ScaleDerivatives::Hessian> factor(joint.hessian);
  const ScaleDerivatives::Gradient step = factor.solve(joint.gradient);
  const double spread = spread_of_scale(parts, form, joint, small.least_blocks);
  if (!step.allFinite() || !std::isfinite(spread)) return result;
  // noise of one sensor alone pulls the scale by at most this: evenly likely anywhere within (solve_scale)
  const Matrix8d translations = cost_matrix(at_scale(all, 1), {0, answered.problem.balance.translation});
  const double attenuation = cost(translations, of.T) / over_scale.curvature;
  result.log_scale = -step[step.size() - 1];
  result.stddev = std::hypot(spread, attenuation / std::sqrt(3.0));
  return result;
}

/// The change in the directions that are known, zero in the others: those are not stated.
Vector6d where_observable(Vector6d moved, const Answered& answered) {
  for (Eigen::Index i = 0; i < 6; ++i)
    if (!answered.observability.observable[static_cast<std::size_t>(i)]) moved[i] = 0;
  return moved;
}

bool beyond_stated(const Vector6d& moved, const Answered& answered, double matters) {
  for (std::size_t i = 0; i < 6; ++i)
    if (std::abs(moved[static_cast<Eigen::Index>(i)]) >
        matters * with_further_parts(answered.observability.stddev[i], answered, i))
      return true;
  return false;
}

/// "67.8 cm, mostly in z"
std::string in_words(const Vector6d& moved, const DiagnosisOptions& options) {
  const double shift = moved.head<3>().norm(), turn = moved.tail<3>().norm();
  const bool turns = turn / options.tolerance_rotation > shift / options.tolerance_translation;
  Eigen::Index most = 0;
  (turns ? moved.tail<3>() : moved.head<3>()).cwiseAbs().maxCoeff(&most);
  return (turns ? format("%.2g deg", turn * degrees_per_radian)
                : length_in_words(shift, options.unit == LengthUnit::metres)) +
         format(", mostly in %s", direction_names[most + (turns ? 3 : 0)]);
}

Finding finding_of_scale(const ScaleOfAnswer& scale, bool another_one, double farthest,
                         const Answered& answered, const DiagnosisOptions& options) {
  Finding finding;
  finding.code = "scale";
  const double size = another_one ? scale.log_scale : farthest;
  const Vector6d moved = where_observable(scale.per * size, answered);
  finding.T_a_b = to_pose(frame_a_moved(answered.T_a_b, moved));
  const std::string evidence = " That moves the answer by " + in_words(moved, options) + ".";
  const char* const cure =
      "{solve}--scale-b auto, or --scale auto if it is the lengths of {a} that may be wrong. Turn more: then "
      "the turns show the lever arm, whatever the lengths are.";
  if (another_one) {
    finding.value = std::exp(size);
    say(finding, format("The lengths of {b} times %.4g fit those of {a}", std::exp(size)), cure,
        format(": by %.0f standard deviations.", scale.sigmas()) + evidence);
  } else {
    say(finding,
        format("The motions do not exclude that the lengths of {b} or of {a} are wrong by %.2g %%",
               100 * std::abs(std::expm1(size))),
        cure, ", as those of right odometries may be." + evidence);
  }
  return finding;
}

}  // namespace

void name_small_scale(const Evidence& evidence, const DiagnosisOptions& options, Answered& answered,
                      Diagnosis& result, const SmallScaleOptions& small) {
  const auto estimated = [](double stddev) { return stddev > 0; };
  if (std::any_of(answered.scale_stddev.begin(), answered.scale_stddev.end(), estimated)) return;
  for (const Finding& finding : result.findings) {
    // right streams, whose answer is less certain than their motions say
    const bool right = finding.code.starts_with("undersampled_") || of_frozen_stream(finding) ||
                       (finding.code == "scale" && finding.value &&
                        std::abs(std::log(*finding.value)) < options.scale_check.least);
    if ((!right && explains(finding, options)) || finding.code == "mount_moved" ||
        finding.code == "scale_change" || finding.code == "units" || finding.code == "too_little_motion")
      return;
  }
  if (!explains(evidence.scaled.explained, options)) return;
  const std::optional<ScaleOfAnswer> scale = scale_of_answer(evidence, answered, options, small);
  if (!scale) return;
  const double farthest = scale->farthest(options.scale_check.least);
  const Vector6d moved = where_observable(scale->per * farthest, answered);
  const Vector6d by_estimate = where_observable(scale->per * scale->log_scale, answered);
  const bool another_one =
      scale->differs(options.scale_check.least, small.significant, options.scale_check.sigmas) &&
      beyond_stated(by_estimate, answered, small.matters) &&
      far_off(frame_a_moved(answered.T_a_b, by_estimate), answered, options) > small.least_move;
  const bool far = far_off(frame_a_moved(answered.T_a_b, moved), answered, options) > 1 &&
                   beyond_stated(moved, answered, small.matters);
  if (!another_one && !far) return;
  const bool named = std::any_of(result.findings.begin(), result.findings.end(),
                                 [](const Finding& one) { return one.code == "scale"; });
  if (!named) result.findings.push_back(finding_of_scale(*scale, another_one, farthest, answered, options));
  for (std::size_t i = 0; i < 6; ++i)
    answered.timing_stddev[i] =
        std::hypot(answered.timing_stddev[i], moved[static_cast<Eigen::Index>(i)] / two_sided_95);
  result.timing_stddev = answered.timing_stddev;
}

}  // namespace egocal::detail
