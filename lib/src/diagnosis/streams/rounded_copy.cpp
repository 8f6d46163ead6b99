// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/rounded_copy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/words/wording.hpp"
#include "statistics/median.hpp"

namespace egocal::detail {

namespace {

/// How numbers were written: so many decimals, or so many significant digits. What holds of both is coarser.
struct Digits {
  int decimals = 0, significant = 0;  ///< 0: of no number that is counted

  bool known() const { return decimals > 0 || significant > 0; }
  /// Between one such number and the next, of about this size.
  double step(double size) const {
    const double by_decimals = decimals > 0 ? std::pow(10, -decimals) : 0;
    const double by_digits =
        significant > 0 && size > 0 ? std::pow(10, std::floor(std::log10(size)) + 1 - significant) : 0;
    return std::max(by_decimals, by_digits);
  }
};

/// Mean square of the rounding of a number that is one of many such [of their unit].
double square_of_rounding(double step) {
  return step * step / 12;
}

/// Whether a number is a multiple of the step, to the rounding of doubles of this size.
bool is_multiple(double number, double step, double size) {
  const double multiple = number / step;
  const double tolerance = 1e-6 + 4e-15 * size / step;
  return tolerance < 0.01 && std::abs(multiple - std::round(multiple)) < tolerance;
}

/// Positions, as they come.
struct Coordinates {
  const Trajectory& trajectory;

  bool written_with(std::size_t i, const Digits& digits) const {
    const Eigen::Vector3d p = position_of(trajectory[i].pose);
    const double size = p.cwiseAbs().maxCoeff();
    return std::all_of(p.begin(), p.end(), [&](double x) {
      const double step = digits.step(std::abs(x));
      return !(step > 0) || is_multiple(x, step, size);
    });
  }
};

/// Quaternions. Those of a file were not quite of unit length; they are up to a factor near one, by which the
/// largest component is such a number.
struct Components {
  const Trajectory& trajectory;

  bool written_with(std::size_t i, const Digits& digits) const {
    const QuaternionVector& q = trajectory[i].pose.real;
    const double largest = q.cwiseAbs().maxCoeff(), step = digits.step(largest);
    if (!(step > 0)) return true;
    for (int more = -2; more <= 2; ++more) {
      const double factor = (std::round(largest / step) + more) * step / largest;
      if (std::all_of(q.begin(), q.end(), [&](double x) {
            const double number = factor * x, of_this = digits.step(std::abs(number));
            return std::abs(x) < 1e-15 || is_multiple(number, of_this, 1);
          }))
        return true;
    }
    return false;
  }
};

template <typename Numbers>
Digits digits_of(const Numbers& numbers, const RoundedCopyOptions& options) {
  const std::size_t n = numbers.trajectory.size();
  const std::size_t each = std::max<std::size_t>(1, n / options.looked_at);
  const auto all_have = [&](const Digits& digits) {
    std::size_t looked = 0, others = 0;
    const auto most_others =
        static_cast<std::size_t>(options.most_others * static_cast<double>(std::min(n, options.looked_at)));
    for (std::size_t i = 0; i < n; i += each, ++looked)
      if (!numbers.written_with(i, digits) && ++others > most_others) return false;
    return looked >= options.fewest;
  };
  Digits result;
  for (int count = 1; count <= options.most_digits && result.decimals == 0; ++count)
    if (all_have({count, 0})) result.decimals = count;
  for (int count = 1; count <= options.most_digits && result.significant == 0; ++count)
    if (all_have({0, count})) result.significant = count;
  return result;
}

struct Written {
  Digits position, rotation;
};

Written written(const Trajectory& trajectory, const RoundedCopyOptions& options) {
  return {digits_of(Coordinates{trajectory}, options), digits_of(Components{trajectory}, options)};
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

/// What is left of motions, and of what size they are.
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
  const Written of_a = written(a, options), of_b = written(b, options);
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
