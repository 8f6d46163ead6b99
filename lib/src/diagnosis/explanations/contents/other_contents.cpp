// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/contents/other_contents.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/contents/other_contents_steps.hpp"
#include "diagnosis/explanations/contents/reversed_steps.hpp"
#include "diagnosis/explanations/times/late_by_a_row.hpp"
#include "diagnosis/explanations/turning/rates_in_degrees.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
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

/// Positions that are summed up: from each pose to the next one the file holds what they change by.
enum class Summed { none, velocity_of_world, velocity_of_sensor, increment };

/// What a file may hold: the pose that each of its poses should have been, and how positions are summed up.
struct Contents {
  const char* words;
  Pose (*right)(const Pose&);
  Summed summed = Summed::none;
};

template <Angles (*right)(const Angles&)>
Pose with_angles(const Pose& pose) {
  return {from_yaw_first(right(yaw_first(pose.rotation.toRotationMatrix()))).normalized(), pose.translation};
}

Angles other_yaw(const Angles& x) {
  return {x[0], x[1], -x[2]};
}
Angles of_compass(const Angles& x) {
  return {x[0], x[1], std::numbers::pi / 2 - x[2]};
}
Angles other_pitch(const Angles& x) {
  return {x[0], -x[1], x[2]};
}
Angles other_roll(const Angles& x) {
  return {-x[0], x[1], x[2]};
}
Angles exchanged(const Angles& x) {
  return {x[1], x[0], x[2]};
}
Angles from_radians(const Angles& x) {
  return degrees_per_radian * x;
}
Pose yaw_instead_of_roll_first(const Pose& pose) {
  return {from_yaw_first(roll_first(pose.rotation.toRotationMatrix())).normalized(), pose.translation};
}
Pose roll_instead_of_yaw_first(const Pose& pose) {
  return {from_roll_first(yaw_first(pose.rotation.toRotationMatrix())).normalized(), pose.translation};
}
Pose turned_position(const Pose& pose) {
  return {pose.rotation, pose.rotation * pose.translation};
}
Pose as_it_is(const Pose& pose) {
  return pose;
}

constexpr const char* in_opposite_order = "roll, pitch and yaw turned in the opposite order";
constexpr std::array<Contents, 12> catalogue{{
    {"its yaw taken with the opposite sign", with_angles<other_yaw>},
    {"90 degrees less its yaw, which is a compass heading", with_angles<of_compass>},
    {"its pitch taken with the opposite sign", with_angles<other_pitch>},
    {"its roll taken with the opposite sign", with_angles<other_roll>},
    {"roll and pitch exchanged", with_angles<exchanged>},
    {"roll, pitch and yaw in radians that were taken as degrees", with_angles<from_radians>},
    {in_opposite_order, yaw_instead_of_roll_first},
    {in_opposite_order, roll_instead_of_yaw_first},
    {"its positions taken to be in the axes of the sensor", turned_position},
    {"its velocities in the axes of the world", as_it_is, Summed::velocity_of_world},
    {"its velocities in the axes of the sensor", as_it_is, Summed::velocity_of_sensor},
    {"its motions since the pose before", as_it_is, Summed::increment},
}};

/// Positions summed up to one instant, as the file holds velocities or increments.
struct Sums {
  Vector3d velocity_of_world = Vector3d::Zero(), velocity_of_sensor = Vector3d::Zero(),
           increment = Vector3d::Zero();

  const Vector3d& of(Summed kind) const {
    return kind == Summed::velocity_of_world    ? velocity_of_world
           : kind == Summed::velocity_of_sensor ? velocity_of_sensor
                                                : increment;
  }
};

/// The ends of one motion of one stream.
struct Ends {
  Pose begin, end;
  Sums to_begin, to_end;
};

Pose pose_at(const Instants& instants, std::size_t i, Side side) {
  const PosePair poses = instants.at(i);
  return to_pose(side == Side::a ? poses.a : poses.b);
}

std::vector<Ends> ends_of(const Instants& instants, const std::vector<std::size_t>& begins, std::size_t span,
                          Side side) {
  std::vector<Ends> ends;
  ends.reserve(begins.size());
  for (const std::size_t i : begins)
    ends.push_back({pose_at(instants, i, side), pose_at(instants, i + span, side), {}, {}});
  return ends;
}

/// Looks at every pose of the drive once; keeps what the motions need.
void sum_up(const Instants& instants, const std::vector<std::size_t>& begins, std::size_t span, Side side,
            std::vector<Ends>& ends) {
  Sums sums;
  Pose before = pose_at(instants, 0, side);
  std::size_t next_begin = 0, next_end = 0;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    if (i > 0) {
      const Pose pose = pose_at(instants, i, side);
      const double seconds = instants.time(i) - instants.time(i - 1);
      sums.velocity_of_world += seconds * pose.translation;
      sums.velocity_of_sensor += seconds * (pose.rotation * pose.translation);
      sums.increment += before.rotation * pose.translation;
      before = pose;
    }
    for (; next_begin < begins.size() && begins[next_begin] == i; ++next_begin)
      ends[next_begin].to_begin = sums;
    for (; next_end < begins.size() && begins[next_end] + span == i; ++next_end) ends[next_end].to_end = sums;
  }
}

/// Every `each`-th of the motions under other contents of one stream; not fitted yet.
Motions motions_under(const Contents& contents, const Motions& given, const std::vector<Ends>& ends,
                      Side side, std::size_t each) {
  Motions motions = given;
  motions.all.clear();
  for (std::size_t i = 0; i < ends.size(); i += each) {
    const Pose begin = contents.right(ends[i].begin), end = contents.right(ends[i].end);
    const Vector3d change =
        contents.summed == Summed::none
            ? Vector3d(end.translation - begin.translation)
            : Vector3d(ends[i].to_end.of(contents.summed) - ends[i].to_begin.of(contents.summed));
    const Rotation back = begin.rotation.conjugate();
    motions.all.push_back(given.all[i]);
    set_turned_motion(motions.all.back(), side, back * end.rotation, back * change);
  }
  measure_sizes(motions);
  return motions;
}

struct Look {
  const Contents* contents = nullptr;
  Side side = Side::b;
  double typical = 0;  ///< RobustFit, of the first look
};

struct Fitted {
  Look candidate;
  Explained explained;
  double gain = 0;  ///< over the streams as given
};

Finding worded_contents(const Fitted& fitted) {
  const char which = fitted.candidate.side == Side::a ? 'a' : 'b';
  const Contents& contents = *fitted.candidate.contents;
  const bool of_positions = contents.summed != Summed::none;
  Finding finding;
  finding.code = std::string(of_positions ? "missing_" : "axes_") + which;
  finding.certain = true;
  finding.improvement = std::exp(fitted.gain);
  finding.T_a_b = to_pose(fitted.explained.fit.T);
  const std::string smaller =
      format("the squared residuals are %.3g times smaller then", finding.improvement);
  if (of_positions)
    say(finding, format("The positions of %s are %s", mark(which), contents.words),
        format("Give the positions of %s.", mark(which)), ": " + smaller + ".");
  else
    say(finding, format("The position and the rotation of %s do not belong together", mark(which)),
        format("Write positions and rotations of %s in the same axes, and angles as the reader takes them.",
               mark(which)),
        format(": with %s, %s.", contents.words, smaller.c_str()));
  return finding;
}

std::vector<Finding> of_catalogue(const Evidence& evidence, const DiagnosisOptions& options,
                                  const OtherContentsOptions& search) {
  const Explained& given = evidence.given.explained;
  const auto span = static_cast<std::size_t>(given.motions.stride);
  const std::size_t each = std::max<std::size_t>(1, given.motions.all.size() / options.motions.first_look);
  const bool agree = explains(evidence.scaled.explained, options);
  const std::vector<std::size_t> begins = begins_of(evidence.instants, given.motions);
  std::array<std::vector<Ends>, 2> ends;  // of a and b
  const auto ends_of_side = [&](Side side) -> std::vector<Ends>& { return ends[side == Side::a ? 0 : 1]; };
  std::vector<Look> candidates;
  for (const Side side : {Side::b, Side::a}) {
    std::vector<Ends>& of_side = ends_of_side(side);
    of_side = ends_of(evidence.instants, begins, span, side);
    if (!agree) sum_up(evidence.instants, begins, span, side, of_side);
    for (const Contents& contents : catalogue) {
      if (agree && contents.summed != Summed::none) continue;
      const Motions sample = motions_under(contents, given.motions, of_side, side, each);
      candidates.push_back({&contents, side, quick_fit(sample, options.fit).typical});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Look& x, const Look& y) { return x.typical < y.typical; });
  candidates.resize(std::min(candidates.size(), search.followed));
  std::vector<Fitted> found;
  for (const Look& candidate : candidates) {
    Explained here{
        motions_under(*candidate.contents, given.motions, ends_of_side(candidate.side), candidate.side, 1),
        {}};
    here.fit = robust_fit(here.motions, options.fit);
    // a free scale may fit worse than none, where few motions decide
    const Comparison with_given = compare(given, here);
    if (!explains(here, options) || !better(with_given, options.gain, options) ||
        !better(compare(evidence.scaled.explained, here), options.gain, options))
      continue;
    // positions far from the origin, turned, are long motions: any residual is a small part of them
    if (candidate.contents->summed == Summed::none && loss_in_metres(given, here) > 0) continue;
    found.push_back({candidate, std::move(here), with_given.gain});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Fitted& x, const Fitted& y) { return x.gain > y.gain; });
  std::vector<Finding> findings;
  std::vector<std::pair<Side, std::string_view>> named;
  for (const Fitted& one : found) {
    if (one.gain < found.front().gain - options.alike) break;
    const std::pair<Side, std::string_view> name{one.candidate.side, one.candidate.contents->words};
    if (std::find(named.begin(), named.end(), name) != named.end()) continue;
    named.push_back(name);
    findings.push_back(worded_contents(one));
  }
  return findings;
}

}  // namespace

std::vector<Finding> other_contents(const Evidence& evidence, const DiagnosisOptions& options,
                                    const OtherContentsOptions& search) {
  if (evidence.given.explained.motions.all.size() < options.motions.least) return {};
  std::vector<Finding> contents = of_catalogue(evidence, options, search);
  if (contents.empty())
    if (std::optional<Finding> rates = rates_in_degrees(evidence, options)) return {*std::move(rates)};
  if (std::vector<Finding> reversed = reversed_steps(evidence, options);
      !reversed.empty() && (contents.empty() || reversed.front().improvement > contents.front().improvement))
    contents = std::move(reversed);
  const std::vector<TurnedSteps> turned = turned_steps(evidence, options);
  const std::vector<LateByARow> late = late_by_a_row(evidence, options);
  const bool late_fit_better = !late.empty() && (turned.empty() || late.front().gain > turned.front().gain);
  std::vector<Finding> steps =
      late_fit_better ? worded_rows(late, evidence) : worded_steps(turned, evidence, options);
  if (contents.empty() || (!steps.empty() && steps.front().improvement > contents.front().improvement))
    return steps.empty() ? contents : steps;
  return contents;
}

}  // namespace egocal::detail
