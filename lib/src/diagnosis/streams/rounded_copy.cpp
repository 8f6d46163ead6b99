// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/rounded_copy.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/streams/written_digits.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Mean square of the rounding of a number that is one of many such [of their unit].
double square_of_rounding(double step) {
  return step * step / 12;
}

/// Mean squares of what rounding makes of a pose: of its rotation about each axis [rad^2], and along each
/// axis [m^2].
struct PoseRounding {
  double rotation = 0, position = 0;
};

PoseRounding pose_rounding(const DualQuaternion& pose, const Written& written) {
  PoseRounding rounding;
  for (const double x : position_of(pose))
    rounding.position += square_of_rounding(written.position.step(std::abs(x))) / 3;
  // a rotation is twice its quaternion
  for (const double x : pose.real)
    rounding.rotation += 4 * square_of_rounding(written.rotation.step(std::abs(x))) / 4;
  return rounding;
}

/// What is left of motions, and the size of the motions.
struct Left {
  double rotation = 0, translation = 0;  ///< over what rounding leaves; medians
  /// Root mean squares: what rounding leaves, and the motions [rad, m].
  double rotation_of_rounding = 0, translation_of_rounding = 0, turned = 0, travelled = 0;
};

Left left_of(const Instants& instants, const Motions& motions, const Pose& T, const Written& of_a,
             const Written& of_b, const RoundedCopyOptions& options) {
  const auto span = static_cast<std::size_t>(motions.stride);
  const std::vector<std::size_t> begins = begins_of(instants, motions);
  std::vector<double> rotations, translations;
  Eigen::Vector4d sums = Eigen::Vector4d::Zero();
  const double arm = T.translation.squaredNorm();
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const Motion& motion = motions.all[i];
    const PosePair begin = instants.at(begins[i]), end = instants.at(begins[i] + span);
    const PoseRounding a0 = pose_rounding(begin.a, of_a), a1 = pose_rounding(end.a, of_a),
                       b0 = pose_rounding(begin.b, of_b), b1 = pose_rounding(end.b, of_b);
    const double turning = std::pow(0.5 * (motion.angle_a + motion.angle_b), 2),
                 way_a = motion.t_a.squaredNorm(), way_b = motion.t_b.squaredNorm();
    const double of_rotation = 3 * (a0.rotation + a1.rotation + b0.rotation + b1.rotation);
    // the rotation at the begin turns the way, that of the whole motion the lever arm
    const double of_translation = 3 * (a0.position + a1.position + b0.position + b1.position) +
                                  2 * (a0.rotation * way_a + b0.rotation * way_b) +
                                  2 * (a0.rotation + a1.rotation) * arm;
    sums += Eigen::Vector4d(of_rotation, of_translation, turning, 0.5 * (way_a + way_b));
    const Residual residual = residual_at(motion, T);
    rotations.push_back(residual.rotation / std::max(std::sqrt(of_rotation), options.least));
    translations.push_back(residual.translation /
                           std::max(std::sqrt(of_translation), options.least * motions.translation));
  }
  // of the length of a vector of three normal numbers, over the root of its mean square
  constexpr double median_of_length = 0.888;
  const Eigen::Vector4d mean = (sums / static_cast<double>(begins.size())).cwiseSqrt();
  return {median(std::move(rotations)) / median_of_length,
          median(std::move(translations)) / median_of_length,
          mean[0],
          mean[1],
          mean[2],
          mean[3]};
}

bool explained_by_rounding(const Left& left, const RoundedCopyOptions& options) {
  return left.rotation <= options.most && left.translation <= options.most;
}

}  // namespace

std::optional<Finding> rounded_copy(const Trajectory& a, const Trajectory& b, const Instants& instants,
                                    bool metres, const RoundedCopyOptions& options) {
  if (instants.size() < options.fewest) return std::nullopt;
  const auto motions_over = [&](std::size_t stride) {
    return motions_of(instants, {}, {}, static_cast<int>(std::max<std::size_t>(1, stride)), options.motions);
  };
  const std::size_t stride = instants.size() / options.parts;
  Motions longer = motions_over(stride);
  if (longer.all.size() < options.fewest) return std::nullopt;
  const RobustFit fit = robust_fit(longer);
  const Pose T = to_pose(fit.T);
  if (!(fit.typical < options.certainly_noise * options.certainly_noise)) return std::nullopt;
  const Written of_a = written(a, options.digits), of_b = written(b, options.digits);
  if (!of_a.position.known() && !of_b.position.known()) return std::nullopt;
  const Left of_longer = left_of(instants, longer, T, of_a, of_b, options);
  const double of_turning = of_longer.rotation_of_rounding / of_longer.turned,
               of_way = of_longer.translation_of_rounding / of_longer.travelled;
  if (!(std::max(of_longer.rotation_of_rounding, of_way) >= options.least) ||
      !(std::max(of_turning, of_way) <= options.most_of_motion) || !explained_by_rounding(of_longer, options))
    return std::nullopt;
  const Motions shorter = motions_over(stride / 8);
  if (shorter.all.size() < options.fewest ||
      !explained_by_rounding(left_of(instants, shorter, T, of_a, of_b, options), options))
    return std::nullopt;
  Finding finding;
  finding.code = "same_stream";
  finding.message = format(
      "The motions agree to the rounding of the files (%.2g deg and %s): one stream was made from the "
      "other, or both were simulated without noise.",
      of_longer.rotation_of_rounding * 180 / std::numbers::pi,
      length_in_words(of_longer.translation_of_rounding, metres).c_str());
  finding.remedy = "Give what each sensor measured by itself; ignore this where the streams were simulated.";
  return finding;
}

}  // namespace egocal::detail
