// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/other_poses.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Roll, pitch and yaw [rad].
using Angles = Vector3d;

/// R = Rz(yaw) Ry(pitch) Rx(roll).
Angles yaw_first(const Matrix3d& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2))),
          std::atan2(R(1, 0), R(0, 0))};
}
Rotation from_yaw_first(const Angles& angles) {
  return rotation_exp({0, 0, angles[2]}) * rotation_exp({0, angles[1], 0}) * rotation_exp({angles[0], 0, 0});
}

/// R = Rx(roll) Ry(pitch) Rz(yaw).
Angles roll_first(const Matrix3d& R) {
  return {std::atan2(-R(1, 2), R(2, 2)), std::atan2(R(0, 2), std::hypot(R(1, 2), R(2, 2))),
          std::atan2(-R(0, 1), R(0, 0))};
}
Rotation from_roll_first(const Angles& angles) {
  return rotation_exp({angles[0], 0, 0}) * rotation_exp({0, angles[1], 0}) * rotation_exp({0, 0, angles[2]});
}

/// What the angles of a file should have been.
struct WrongAngles {
  const char* as;  ///< "with ..., the residuals are smaller"
  Angles (*right)(const Angles&);
};
constexpr double half_pi = std::numbers::pi / 2;
constexpr std::array<WrongAngles, 6> wrong_angles{{
    {"its yaw taken with the opposite sign", [](const Angles& x) { return Angles(x[0], x[1], -x[2]); }},
    {"90 degrees less its yaw, which is a compass heading",
     [](const Angles& x) { return Angles(x[0], x[1], half_pi - x[2]); }},
    {"its pitch taken with the opposite sign", [](const Angles& x) { return Angles(x[0], -x[1], x[2]); }},
    {"its roll taken with the opposite sign", [](const Angles& x) { return Angles(-x[0], x[1], x[2]); }},
    {"roll and pitch exchanged", [](const Angles& x) { return Angles(x[1], x[0], x[2]); }},
    {"roll, pitch and yaw in radians that were taken as degrees",
     [](const Angles& x) { return Angles(180 / std::numbers::pi * x); }},
}};

/// Another trajectory that a file may mean. Its poses are made when they are asked for: those of a long drive
/// take much memory.
struct Contents {
  bool of_positions = false;  ///< these are missing
  std::string words;
  std::function<std::vector<Pose>()> poses;
};

/// The given poses, which must outlive it, with other rotations.
Contents with_rotations(const char* words, const std::vector<Pose>& given,
                        std::function<Rotation(const Matrix3d&)> right) {
  return {false, words, [&given, right = std::move(right)] {
            std::vector<Pose> poses = given;
            for (Pose& pose : poses) pose.rotation = right(pose.rotation.toRotationMatrix()).normalized();
            return poses;
          }};
}

std::vector<Contents> other_angles(const std::vector<Pose>& given) {
  std::vector<Contents> all;
  for (const WrongAngles& wrong : wrong_angles)
    all.push_back(with_rotations(wrong.as, given, [right = wrong.right](const Matrix3d& R) {
      return from_yaw_first(right(yaw_first(R)));
    }));
  constexpr const char* in_order = "roll, pitch and yaw turned in the opposite order";
  all.push_back(
      with_rotations(in_order, given, [](const Matrix3d& R) { return from_yaw_first(roll_first(R)); }));
  all.push_back(
      with_rotations(in_order, given, [](const Matrix3d& R) { return from_roll_first(yaw_first(R)); }));
  return all;
}

/// The position is what the file has, in each step from the pose before it, after `seconds`.
std::vector<Pose> summed_up(
    const Instants& instants, const std::vector<Pose>& given,
    const std::function<Vector3d(const Pose& before, const Pose& pose, double seconds)>& step) {
  std::vector<Pose> poses = given;
  for (std::size_t i = 1; i < given.size(); ++i)
    poses[i].translation =
        poses[i - 1].translation + step(given[i - 1], given[i], instants.time(i) - instants.time(i - 1));
  return poses;
}

std::vector<Contents> other_positions(const Instants& instants, const std::vector<Pose>& given) {
  return {{false, "its positions taken to be in the axes of the sensor",
           [&given] {
             std::vector<Pose> poses = given;
             for (Pose& pose : poses) pose.translation = pose.rotation * pose.translation;
             return poses;
           }},
          {true, "its velocity in the axes of the world",
           [&] {
             return summed_up(instants, given, [](const Pose&, const Pose& pose, double seconds) {
               return Vector3d(seconds * pose.translation);
             });
           }},
          {true, "its velocity in the axes of the sensor",
           [&] {
             return summed_up(instants, given, [](const Pose&, const Pose& pose, double seconds) {
               return Vector3d(seconds * (pose.rotation * pose.translation));
             });
           }},
          {true, "its motion since the pose before", [&] {
             return summed_up(instants, given, [](const Pose& before, const Pose& pose, double) {
               return Vector3d(before.rotation * pose.translation);
             });
           }}};
}

Finding worded_contents(const Contents& contents, Side side, const Explained& explained,
                        const Comparison& comparison) {
  const char which = side == Side::a ? 'a' : 'b';
  Finding finding;
  finding.code = std::string(contents.of_positions ? "missing_" : "axes_") + which;
  finding.certain = true;
  finding.improvement = std::exp(comparison.gain);
  finding.T_a_b = to_pose(explained.fit.T);
  const std::string smaller =
      format("the squared residuals are %.3g times smaller then", finding.improvement);
  if (contents.of_positions)
    say(finding, format("What stands as the position of %s is %s", mark(which), contents.words.c_str()),
        format("Give the positions of %s.", mark(which)), ": " + smaller + ".");
  else
    say(finding, format("The position and the rotation of %s do not belong together", mark(which)),
        format("Write positions and rotations of %s in the same axes, and angles as the reader takes them.",
               mark(which)),
        format(": with %s, %s.", contents.words.c_str(), smaller.c_str()));
  return finding;
}

}  // namespace

std::vector<Pose> poses_of(const Instants& instants, Side side) {
  std::vector<Pose> poses;
  poses.reserve(instants.size());
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const PosePair both = instants.at(i);
    poses.push_back(to_pose(side == Side::a ? both.a : both.b));
  }
  return poses;
}

Explained with_poses(const Instants& instants, const Explained& given, Side side,
                     const std::vector<Pose>& poses, const DiagnosisOptions& options) {
  Explained result{given.motions, {}};
  const auto span = static_cast<std::size_t>(given.motions.stride);
  const std::vector<std::size_t> begins = begins_of(instants, given.motions);
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const Pose motion = inverse(poses[begins[i]]) * poses[begins[i] + span];
    set_turned_motion(result.motions.all[i], side, motion.rotation, motion.translation);
  }
  measure_sizes(result.motions);
  result.fit = robust_fit(result.motions, options.fit);
  return result;
}

std::optional<Finding> other_contents(const Evidence& evidence, const DiagnosisOptions& options) {
  const Explained& given = evidence.given.explained;
  if (given.motions.all.size() < options.motions.least || explains(evidence.scaled.explained, options))
    return std::nullopt;
  std::optional<Finding> best;
  for (const Side side : {Side::b, Side::a}) {
    const std::vector<Pose> poses = poses_of(evidence.instants, side);
    std::vector<Contents> all = other_angles(poses);
    for (Contents& contents : other_positions(evidence.instants, poses)) all.push_back(std::move(contents));
    for (const Contents& contents : all) {
      const Explained here = with_poses(evidence.instants, given, side, contents.poses(), options);
      if (!explains(here, options) ||
          !better(compare(evidence.scaled.explained, here), options.gain, options))
        continue;
      const Comparison comparison = compare(given, here);
      if (!best || std::exp(comparison.gain) > best->improvement)
        best = worded_contents(contents, side, here, comparison);
    }
  }
  return best;
}

}  // namespace egocal::detail
