// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The extrinsic beside two times of one stream, that of its rotations and that of its positions.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "diagnosis/motions/mount_fit.hpp"
#include "diagnosis/motions/robust_fit.hpp"

namespace egocal::detail {

struct TwoTimesOptions {
  /// Turning rates and speeds are those over at least this time [s]. What shakes in less hides turns that
  /// take seconds: at 0.1 s a tenth of the time was found on a tram, at 0.5 s all of it.
  double least_span = 0.5;
  std::size_t most_instants = 200;  ///< that it spans on either side, at most: a stream of 1 kHz has as many
  double across_a_gap = 2;          ///< motions of more than this many times their usual duration span a gap
  MountFitOptions fit;
};

/// The two numbers beside the mounting are times [s], > 0 where they are those of later times.
constexpr int time_of_rotations = first_number, time_of_positions = second_number;
constexpr int time_about_axis = first_number, time_about_others = second_number;

/// One stream and its mounting in the other one. The rotations count about one axis, in the frame of the
/// stream: a vehicle shakes about the others. Without an axis it is the one that the stream mostly turns
/// about.
class StreamOfTwoTimes {
 public:
  StreamOfTwoTimes(const Instants& instants, const Explained& given, Side side,
                   const TwoTimesOptions& options);
  StreamOfTwoTimes(const Instants& instants, const Explained& given, Side side,
                   const TwoTimesOptions& options, const Eigen::Vector3d& axis);
  /// Motions of the drive, in its order; those without poses to measure rates from are omitted.
  std::vector<LinearMotion> motions(const Explained& given, std::size_t most) const;
  /// The motions by their rotations alone: the two numbers are times of the turning about the axis, and of
  /// the turning about all others.
  std::vector<LinearMotion> rotations(const Explained& given, std::size_t most) const;
  /// The pose of b in a with the mounting moved.
  DualQuaternion T_a_b(const MountNumbers& x) const;

 private:
  struct Poses {
    Pose own, other;
  };
  /// Turning [rad/s] in the stream's frame, as both streams see it; velocity in its world [m/s].
  struct Rates {
    Eigen::Vector3d turning, velocity;
  };
  bool has(std::size_t i) const;
  LinearMotion motion(std::size_t i) const;
  LinearMotion rotation(std::size_t i) const;
  std::vector<std::size_t> begins(const Explained& given, std::size_t most) const;
  Poses at(std::size_t i) const;
  Rates rates(std::size_t i) const;

  const Instants& instants_;
  Side side_;
  Pose T_;
  Eigen::Matrix3d R_, about_axis_;
  std::size_t span_, reach_;  ///< of a motion, and of rates on either side [instants]
  double longest_;            ///< [s]
};

}  // namespace egocal::detail
