// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/turning/turning_of_steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/other_poses.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Angle of b over that of a, median of the motions in which a turns more than usual; empty: nothing turns.
std::optional<double> ratio_of_turns(const Motions& motions) {
  std::vector<double> angles, ratios;
  for (const Motion& motion : motions.all) angles.push_back(std::sqrt(motion.angle_a * motion.angle_b));
  const double least = angles.empty() ? 0 : median(angles);
  for (std::size_t i = 0; i < angles.size(); ++i)
    if (angles[i] > 0 && angles[i] >= least)
      ratios.push_back(motions.all[i].angle_b / motions.all[i].angle_a);
  if (ratios.empty()) return std::nullopt;
  return median(std::move(ratios));
}

/// Poses of a stream whose steps turn by `part` of what its file says, at each instant. right_positions:
/// those of the file; else they were summed up with the wrong rotations.
std::vector<Pose> corrected(const std::vector<Pose>& given, double part, bool right_positions) {
  std::vector<Pose> poses = given;
  for (std::size_t i = 1; i < given.size(); ++i) {
    const Rotation back = given[i - 1].rotation.conjugate();
    const Rotation& before = poses[i - 1].rotation;
    if (!right_positions)
      poses[i].translation =
          poses[i - 1].translation + before * (back * (given[i].translation - given[i - 1].translation));
    const Rotation turn = rotation_exp(part * rotation_log(back * given[i].rotation));
    poses[i].rotation = (before * turn).normalized();
  }
  return poses;
}

Finding worded_turning(Side side, double factor, const Explained& explained, const Comparison& comparison) {
  const char which = side == Side::a ? 'a' : 'b';
  Finding finding = finding_of(std::string("turning_scale_") + which, explained, comparison, true);
  finding.value = factor;
  say(finding,
      format(
          "The rotations of %s turn %.4g times as far as they should from each pose to the next one, about "
          "all axes: the squared residuals are %.3g times smaller without that.",
          mark(which), factor, finding.improvement),
      format("Correct how the rotations of %s are summed up: the unit and the scale of its gyroscope, and a "
             "quaternion has half the angle of its rotation vector.",
             mark(which)));
  return finding;
}

}  // namespace

bool turns_too_far_by_more_than_noise(const Instants& instants, const Motions& motions, double ratio,
                                      const DiagnosisOptions& options, const TurningOfStepsOptions& turning) {
  const int longer = turning.longer * motions.stride, shorter = motions.stride / turning.longer;
  const bool fits = static_cast<std::size_t>(longer) < instants.size();
  if (!fits && shorter < 1) return false;
  const std::optional<double> other = ratio_of_turns(
      motions_of(instants, {}, {}, fits ? longer : shorter, options.motions.most, options.motions));
  if (!other) return false;
  const double of_longer = std::log(fits ? *other : ratio), of_shorter = std::log(fits ? ratio : *other);
  return of_longer / of_shorter >= turning.part_of_longer;
}

std::vector<Finding> turning_of_steps(const Instants& instants, const Explained& given,
                                      const DiagnosisOptions& options, const TurningOfStepsOptions& turning) {
  const std::optional<double> ratio = ratio_of_turns(given.motions);
  if (!ratio || !(std::abs(*ratio - 1) >= turning.least) ||
      !turns_too_far_by_more_than_noise(instants, given.motions, *ratio, options, turning))
    return {};
  struct Better {
    Side side;
    double factor;
    Explained explained;
    Comparison comparison;
  };
  std::vector<Better> found;
  for (const Side side : {Side::b, Side::a}) {
    const double factor = side == Side::b ? *ratio : 1 / *ratio;
    const std::vector<Pose> poses = poses_of(instants, side);
    std::optional<Better> of_side;
    for (const bool right_positions : {false, true}) {
      Explained here =
          with_poses(instants, given, side, corrected(poses, 1 / factor, right_positions), options);
      const Comparison comparison = compare(given, here);
      if (!explains(here, options) || !better(comparison, turning.gain, options)) continue;
      if (!of_side || comparison.gain > of_side->comparison.gain)
        of_side = Better{side, factor, std::move(here), comparison};
    }
    if (of_side) found.push_back(*std::move(of_side));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Better& x, const Better& y) { return x.comparison.gain > y.comparison.gain; });
  std::vector<Finding> findings;
  for (const Better& one : found) {
    // which stream it is may be open
    if (one.comparison.gain < found.front().comparison.gain - options.alike) break;
    findings.push_back(worded_turning(one.side, one.factor, one.explained, one.comparison));
  }
  return findings;
}

}  // namespace egocal::detail
