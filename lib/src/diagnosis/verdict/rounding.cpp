// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/rounding.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/motions/reading.hpp"

namespace egocal::detail {

namespace {

/// The nearest of the numbers (coarser k + offset) step.
double rounded(double x, double step, int coarser, int offset) {
  if (!(step > 0)) return x;
  return (coarser * std::round((x / step - offset) / coarser) + offset) * step;
}

Trajectory rounded(Trajectory trajectory, const Written& written, int coarser, int offset) {
  for (StampedPose& stamped : trajectory) {
    Pose pose = to_pose(stamped.pose);
    Eigen::Vector4d q = pose.rotation.coeffs();
    for (double& x : q) x = rounded(x, written.rotation.step(std::abs(x)), coarser, offset);
    for (double& x : pose.translation) x = rounded(x, written.position.step(std::abs(x)), coarser, offset);
    if (q.squaredNorm() > 0) pose.rotation = Eigen::Quaterniond(Eigen::Vector4d(q.normalized()));
    stamped.pose = to_dual_quaternion(pose);
  }
  return trajectory;
}

/// Steps of one written unit length and of the farthest position of this stream, of the usual motion.
bool matters(const Trajectory& trajectory, const Written& written, const Motions& motions, double least) {
  double place = 0;
  for (const StampedPose& stamped : trajectory)
    place = std::max(place, position_of(stamped.pose).cwiseAbs().maxCoeff());
  return written.rotation.step(1) > least * motions.rotation ||
         written.position.step(place) > least * motions.translation;
}

}  // namespace

std::array<double, 6> rounding_stddev(const MiddlePart& part, const Instants& instants, int stride,
                                      const Motions& motions, const DualQuaternion& T_a_b, double time_offset,
                                      double max_gap, const DiagnosisOptions& options,
                                      const RoundingOptions& tuning) {
  std::array<double, 6> stddev{};
  const Written of_a = written(part.a, tuning.digits), of_b = written(part.b, tuning.digits);
  if (!matters(part.a, of_a, motions, tuning.least) && !matters(part.b, of_b, motions, tuning.least))
    return stddev;
  AnswerChangeOptions change = options.change;
  change.motions = tuning.motions;
  change.longer = std::max(1, stride);
  const int coarser = tuning.coarser;
  const double number = coarser;
  Vector6d mean = Vector6d::Zero(), squares = Vector6d::Zero();
  for (int offset = 0; offset < coarser; ++offset) {
    const Trajectory a = rounded(part.a, of_a, coarser, offset), b = rounded(part.b, of_b, coarser, offset);
    const Instants otherwise = synchronised(a, b, {time_offset, 0, 0}, max_gap, 1, options.motions);
    const std::optional<AnswerChange> one = answer_change(instants, otherwise, T_a_b, change);
    if (!one) return stddev;
    mean += one->size / number;
    // what is chance in each part is in the scatter between them
    squares += (one->size.cwiseAbs2() - one->variance) / number;
  }
  // The errors that the offsets make of a number add up to nothing, so their mean has no part that is linear
  // in them. Their variance, and what that moves an answer by, is n^2 - 1 times that of the rounding before.
  const double times = number * number - 1;
  const Vector6d linear = (squares - mean.cwiseAbs2()).cwiseMax(0.0) / times, quadratic = mean / times;
  for (Eigen::Index i = 0; i < 6; ++i)
    stddev[static_cast<std::size_t>(i)] = std::sqrt(linear[i] + quadratic[i] * quadratic[i]);
  return stddev;
}

}  // namespace egocal::detail
