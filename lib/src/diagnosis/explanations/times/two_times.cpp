// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/two_times.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/speeds.hpp"
#include "linear_algebra/cross_matrix.hpp"

namespace egocal::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Vector3d main_axis(const Motions& motions, Side side) {
  Matrix3d turns = Matrix3d::Zero();
  for (const Motion& motion : motions.all) {
    const Vector3d turn = rotation_log(to_pose(side == Side::b ? motion.b : motion.a).rotation);
    turns += turn * turn.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(turns).eigenvectors().col(2);
}

}  // namespace

StreamOfTwoTimes::StreamOfTwoTimes(const Instants& instants, const Explained& given, Side side,
                                   const TwoTimesOptions& options)
    : StreamOfTwoTimes(instants, given, side, options, main_axis(given.motions, side)) {}

StreamOfTwoTimes::StreamOfTwoTimes(const Instants& instants, const Explained& given, Side side,
                                   const TwoTimesOptions& options, const Vector3d& axis)
    : instants_(instants),
      side_(side),
      T_(side == Side::b ? to_pose(given.fit.T) : inverse(to_pose(given.fit.T))),
      R_(T_.rotation.toRotationMatrix()),
      about_axis_(axis * axis.transpose()),
      span_(static_cast<std::size_t>(given.motions.stride)),
      reach_(reach_of_rates(instants, options.least_span, options.most_instants)),
      longest_(options.across_a_gap * static_cast<double>(span_ + 2 * reach_) * instants.period) {}

bool StreamOfTwoTimes::has(std::size_t i) const {
  const std::size_t last = i + span_ + reach_;
  return i >= reach_ && last < instants_.size() &&
         instants_.time(last) - instants_.time(i - reach_) <= longest_;
}

std::vector<std::size_t> StreamOfTwoTimes::begins(const Explained& given, std::size_t most) const {
  const std::vector<std::size_t> all = begins_of(instants_, given.motions);
  const std::size_t n = std::min(all.size(), most);
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < n; ++k)
    if (const std::size_t i = all[k * all.size() / n]; has(i)) begins.push_back(i);
  return begins;
}

std::vector<LinearMotion> StreamOfTwoTimes::motions(const Explained& given, std::size_t most) const {
  std::vector<LinearMotion> motions;
  for (const std::size_t i : begins(given, most)) motions.push_back(motion(i));
  return motions;
}

std::vector<LinearMotion> StreamOfTwoTimes::rotations(const Explained& given, std::size_t most) const {
  std::vector<LinearMotion> rotations;
  for (const std::size_t i : begins(given, most)) rotations.push_back(rotation(i));
  return rotations;
}

/// With rotations R(t + r) and positions p(t + s) in place of R(t) and p(t), and the mounting moved by a turn
/// x and a shift y, R_a T = T R_b is linear in r, s, x and y. Turning rates are w, velocities v:
///   log(R_T' R_a R_T R_b') = (1 - R_b) x + r (w - R_b w'),
///   R_T' (R_a t + t_a - t) - t_b = (1 - R_b) y - t_b x x + r w x t_b - s R' (v' - v),
/// where ' at w and v is the end of the motion, and R' turns from the stream's world to its begin.
LinearMotion StreamOfTwoTimes::motion(std::size_t i) const {
  const Poses from = at(i), to = at(i + span_);
  const Rates rates_from = rates(i), rates_to = rates(i + span_);
  const Pose other = inverse(from.other) * to.other, own = inverse(from.own) * to.own;
  const Matrix3d turned = own.rotation.toRotationMatrix(), apart = Matrix3d::Identity() - turned;
  LinearMotion result;
  result.rotation =
      rotation_log(T_.rotation.conjugate() * other.rotation * T_.rotation * own.rotation.conjugate());
  result.translation =
      R_.transpose() * (other.rotation * T_.translation + other.translation - T_.translation) -
      own.translation;
  const Vector3d begins = about_axis_ * rates_from.turning, ends = about_axis_ * rates_to.turning;
  result.of_rotation << apart, Matrix3d::Zero(), begins - turned * ends, Vector3d::Zero();
  result.of_translation << -cross_matrix(own.translation), apart, begins.cross(own.translation),
      from.own.rotation.conjugate() * (rates_from.velocity - rates_to.velocity);
  return result;
}

LinearMotion StreamOfTwoTimes::rotation(std::size_t i) const {
  const Rates rates_from = rates(i), rates_to = rates(i + span_);
  LinearMotion result = motion(i);
  const Matrix3d turned = Matrix3d::Identity() - result.of_rotation.leftCols<3>(),
                 about_others = Matrix3d::Identity() - about_axis_;
  result.of_rotation.col(time_about_others) =
      about_others * rates_from.turning - turned * about_others * rates_to.turning;
  result.of_translation.setZero();
  result.translation.setZero();
  return result;
}

DualQuaternion StreamOfTwoTimes::T_a_b(const MountNumbers& x) const {
  const Pose T{T_.rotation * rotation_exp(x.head<3>()), T_.translation + R_ * x.segment<3>(3)};
  return to_dual_quaternion(side_ == Side::b ? T : inverse(T));
}

StreamOfTwoTimes::Poses StreamOfTwoTimes::at(std::size_t i) const {
  const PosePair poses = instants_.at(i);
  return side_ == Side::b ? Poses{to_pose(poses.b), to_pose(poses.a)}
                          : Poses{to_pose(poses.a), to_pose(poses.b)};
}

StreamOfTwoTimes::Rates StreamOfTwoTimes::rates(std::size_t i) const {
  const Poses from = at(i - reach_), to = at(i + reach_);
  const double seconds = instants_.time(i + reach_) - instants_.time(i - reach_);
  const Vector3d by_own = rotation_log(from.own.rotation.conjugate() * to.own.rotation),
                 by_other =
                     R_.transpose() * rotation_log(from.other.rotation.conjugate() * to.other.rotation);
  return {(by_own + by_other) / (2 * seconds), (to.own.translation - from.own.translation) / seconds};
}

}  // namespace egocal::detail
