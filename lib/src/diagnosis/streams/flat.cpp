// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/flat.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "diagnosis/streams/turning_axis.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "linear_algebra/symmetric_eigen.hpp"

namespace egocal::detail {

namespace {

/// A stream whose positions lack a coordinate: one that never changes although the sensor tilts, which on a
/// plane it would not.
struct Flatness {
  char coordinate = 0;  ///< x, y or z of the file; 0: none
  double tilt = 0;      ///< root mean square of the turning out of the plane of the other two [rad]
};

/// How a stream tilts in motions of one length beside one that turns in a plane, whatever its axes are: root
/// mean squares [rad].
struct Tilting {
  double tilt = 0;   ///< of the axis that tilts least
  double noise = 0;  ///< difference of what both streams turn about that axis and in the plane
};

Tilting tilting(const Instants& instants, Side side, const FlatOptions& options) {
  const int stride = std::max(1, static_cast<int>(instants.size() / options.parts));
  const Motions motions = motions_of(instants, {}, {}, stride, options.most);
  if (motions.all.size() < options.least) return {};
  const Side plane = side == Side::a ? Side::b : Side::a;
  const TurningAxis tilts = turning_axis(motions, side), level = turning_axis(motions, plane);
  return {tilts.tilt, turning_difference(motions, side == Side::a ? tilts.axis : level.axis,
                                         side == Side::a ? level.axis : tilts.axis)};
}

Flatness flatness(const Trajectory& trajectory, const FlatOptions& options) {
  Flatness result;
  if (trajectory.size() < options.least) return result;
  const std::size_t each = std::max<std::size_t>(1, trajectory.size() / options.most);
  const Pose first = to_pose(trajectory.front().pose);
  Eigen::Vector3d low = first.translation, high = low, tilt = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < trajectory.size(); i += each, count += 1) {
    const Pose pose = to_pose(trajectory[i].pose);
    low = low.cwiseMin(pose.translation);
    high = high.cwiseMax(pose.translation);
    const Eigen::Vector3d turn = 2 * (pose.rotation * first.rotation.conjugate()).vec();
    tilt += (turn.squaredNorm() - turn.array().square()).matrix();
  }
  const Eigen::Vector3d range = high - low;
  Eigen::Index flat = 0;
  if (range.minCoeff(&flat) > options.flat * range.maxCoeff() || !(range.maxCoeff() > 0)) return result;
  // a stream that moves along one axis lacks two coordinates, and any motion along it is that of a plane
  if ((range.array() <= options.flat * range.maxCoeff()).count() > 1) return result;
  result.coordinate = "xyz"[flat];
  result.tilt = std::sqrt(tilt[flat] / count);
  return result;
}

/// Whether a stream turns, and about one axis of its world alone.
bool turns_about_one_axis(const Trajectory& trajectory, const FlatOptions& options) {
  if (trajectory.size() < options.least) return false;
  const std::size_t each = std::max<std::size_t>(1, trajectory.size() / options.most);
  const Rotation back = to_pose(trajectory.front().pose).rotation.conjugate();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < trajectory.size(); i += each, count += 1) {
    const Eigen::Vector3d turn = 2 * (to_pose(trajectory[i].pose).rotation * back).vec();
    squares += turn * turn.transpose();
  }
  const SymmetricEigen<3> eigen = symmetric_eigen<3>(squares);
  return std::sqrt(std::max(0.0, eigen.values[0] + eigen.values[1]) / count) <= options.level &&
         std::sqrt(eigen.values[2] / count) > options.least_tilt;
}

/// tilt: of the other stream [rad].
Finding never_tilts(char which, double tilt) {
  Finding finding;
  finding.code = std::string("flat_") + which;
  finding.certain = true;
  say(finding,
      format("The rotations of %s are about one axis alone although %s tilts by %.1f deg: roll and pitch are "
             "missing.",
             mark(which), mark(which == 'a' ? 'b' : 'a'), tilt * degrees_per_radian),
      format("Give whole rotations of %s, or ground planes (planar mode).", mark(which)));
  return finding;
}

/// tilt: its own, or that of the other stream where it has none itself [rad].
Finding level_positions(char which, char coordinate, double tilt, bool of_other) {
  Finding finding;
  finding.code = std::string("flat_") + which;
  finding.certain = true;
  const std::string claim =
      of_other ? format(
                     "The positions of %s never change in %c, and it turns about that axis alone, although "
                     "%s tilts by %.1f deg: an odometry in two dimensions beside one in three.",
                     mark(which), coordinate, mark(which == 'a' ? 'b' : 'a'), tilt * degrees_per_radian)
               : format(
                     "The positions of %s never change in %c although it tilts by %.1f deg: a coordinate is "
                     "missing.",
                     mark(which), coordinate, tilt * degrees_per_radian);
  say(finding, claim,
      format("Give positions of %s in three dimensions, or ground planes (planar mode).", mark(which)));
  return finding;
}

}  // namespace

std::optional<Finding> flat(const Trajectory& own, Side side, const Instants& instants,
                            const FlatOptions& options) {
  const char which = side == Side::a ? 'a' : 'b';
  const Flatness found = flatness(own, options);
  const bool no_coordinate = found.coordinate == 0;
  if (!no_coordinate && found.tilt > options.least_tilt)
    return level_positions(which, found.coordinate, found.tilt, false);
  if (no_coordinate ? !turns_about_one_axis(own, options) : found.tilt > options.level) return std::nullopt;
  const Tilting other = tilting(instants, side == Side::a ? Side::b : Side::a, options);
  if (!(other.tilt > options.least_tilt && other.tilt > options.over_noise * other.noise))
    return std::nullopt;
  return no_coordinate ? never_tilts(which, other.tilt)
                       : level_positions(which, found.coordinate, other.tilt, true);
}

}  // namespace egocal::detail
