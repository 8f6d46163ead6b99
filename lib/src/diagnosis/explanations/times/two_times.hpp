// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The extrinsic beside two times of one stream, that of its rotations and that of its positions.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"

namespace egocal::detail {

struct TwoTimesOptions {
  /// Turning rates and speeds are those over at least this time [s]. What shakes in less hides turns that
  /// take seconds: at 0.1 s a tenth of the time was found on a tram, at 0.5 s all of it.
  double least_span = 0.5;
  std::size_t most_instants = 200;  ///< that it spans on either side, at most: a stream of 1 kHz has as many
  std::size_t most = 400;           ///< motions, evenly spread: a limit on time
  double across_a_gap = 2;          ///< motions of more than this many times their usual duration span a gap
  /// Squares beyond this many times the median one lose weight: ten standard deviations. The few motions into
  /// and out of turns have up to ten times the residual of the others, and are all the evidence there is.
  double outlier = 100;
  int rounds = 5;          ///< of weights; more change nothing
  std::size_t parts = 24;  ///< of the drive, which the jack-knife omits in turn
};

/// Turn and shift of the mounting in the stream's frame [rad, m], times of rotations and of positions [s]:
/// > 0 where they are those of later times.
using TwoTimes = Eigen::Matrix<double, 8, 1>;
constexpr int time_of_rotations = 6, time_of_positions = 7;  // places in TwoTimes

/// What one motion leaves, and what each of the eight numbers explains of it [rad, m].
struct TwoTimesMotion {
  Eigen::Matrix<double, 3, 8> of_rotation, of_translation;
  Eigen::Vector3d rotation, translation;
};

/// One stream and its mounting in the other one. The rotations count about the axis that it mostly turns
/// about: a vehicle shakes about the others.
class StreamOfTwoTimes {
 public:
  StreamOfTwoTimes(const Instants& instants, const Explained& given, Side side,
                   const TwoTimesOptions& options);
  /// Of the drive, in its order; those without poses to measure rates from are omitted.
  std::vector<TwoTimesMotion> motions(const Explained& given, std::size_t most) const;
  /// The pose of b in a with the mounting moved.
  DualQuaternion T_a_b(const TwoTimes& x) const;

 private:
  struct Poses {
    Pose own, other;
  };
  /// Turning about the axis [rad/s] in the stream's frame, as both streams see it; velocity in its world
  /// [m/s].
  struct Rates {
    Eigen::Vector3d turning, velocity;
  };
  bool has(std::size_t i) const;
  TwoTimesMotion motion(std::size_t i) const;
  Poses at(std::size_t i) const;
  Rates rates(std::size_t i) const;

  const Instants& instants_;
  Side side_;
  Pose T_;
  Eigen::Matrix3d R_, about_axis_;
  std::size_t span_, reach_;  ///< of a motion, and of rates on either side [instants]
  double longest_;            ///< [s]
};

/// `first`: the first of the two numbers alone.
enum class FreeTimes { none, first, one_for_both, two };

/// Reweighted linear least squares, in parts of the drive. The motions must stay.
class TwoTimesFit {
 public:
  TwoTimesFit(const std::vector<TwoTimesMotion>& motions, const TwoTimesOptions& options);
  TwoTimes best(FreeTimes free) const { return without(options_.parts, free); }
  /// Of a linear function of the numbers, by omitting parts.
  double stddev(const TwoTimes& of) const;
  /// Mean logarithm of the squares at x over those at y, above the noise.
  double gain(const TwoTimes& x, const TwoTimes& y) const;

 private:
  double square(const TwoTimesMotion& motion, const TwoTimes& x) const;
  void measure(const TwoTimes& x);
  void add_up(const std::vector<double>& weights);
  TwoTimes without(std::size_t omitted, FreeTimes free) const;

  const std::vector<TwoTimesMotion>& motions_;
  TwoTimesOptions options_;
  std::vector<Eigen::Matrix<double, 8, 8>> sums_;  ///< of each part
  std::vector<TwoTimes> right_;
  double rotation_ = 1, translation_ = 1;  ///< median squares [rad^2, m^2]
};

}  // namespace egocal::detail
