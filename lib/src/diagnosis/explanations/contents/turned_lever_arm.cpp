// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/contents/turned_lever_arm.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/stillest_point.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// What a lever arm of one metre along each axis, turned by the inverse rotations, adds to the translation of
/// each motion, in the frame of its begin: R_0'(R_1' - R_0').
struct ByLeverArm {
  std::vector<Matrix3d> a, b;
  const std::vector<Matrix3d>& of(Side side) const { return side == Side::a ? a : b; }
};

ByLeverArm by_lever_arm(const Instants& instants, const Motions& motions) {
  const auto span = static_cast<std::size_t>(motions.stride);
  ByLeverArm result;
  for (const std::size_t i : begins_of(instants, motions)) {
    const PosePair begin = instants.at(i), end = instants.at(i + span);
    const auto added = [](const DualQuaternion& from, const DualQuaternion& to) {
      const Matrix3d back = rotation_of(from).transpose();
      return Matrix3d(back * (rotation_of(to).transpose() - back));
    };
    result.a.push_back(added(begin.a, end.a));
    result.b.push_back(added(begin.b, end.b));
  }
  return result;
}

/// What each motion gains where the lever arm is taken out of its stream.
std::vector<Vector3d> without(const std::vector<Matrix3d>& added, const Vector3d& lever) {
  std::vector<Vector3d> changes;
  changes.reserve(added.size());
  for (const Matrix3d& one : added) changes.emplace_back(-(one * lever));
  return changes;
}

struct Lever {
  Side side = Side::b;
  Vector3d arm = Vector3d::Zero();
  Explained explained;
  Comparison comparison;
};

Lever fitted(const Explained& given, const std::vector<Matrix3d>& added, Side side,
             const DiagnosisOptions& options) {
  Lever lever{side, Vector3d::Zero(), given, {}};
  for (int round = 0; round < options.fit.rounds; ++round) {
    lever.arm -= best_numbers<3>(lever.explained, added, side);
    lever.explained.motions = with_added(given.motions, without(added, lever.arm), side);
    lever.explained.fit = robust_fit(lever.explained.motions, options.fit);
  }
  lever.comparison = compare(given, lever.explained);
  return lever;
}

}  // namespace

std::optional<Finding> turned_lever_arm(const Instants& instants, const Explained& given,
                                        const DiagnosisOptions& options, const TurnedLeverArmOptions& lever) {
  if (given.motions.all.size() < options.motions.least) return std::nullopt;
  const ByLeverArm added = by_lever_arm(instants, given.motions);
  std::optional<Lever> best;
  for (const Side side : {Side::b, Side::a}) {
    Lever here = fitted(given, added.of(side), side, options);
    if (!here.arm.allFinite() || here.arm.norm() < lever.least || !explains(here.explained, options) ||
        !better(here.comparison, options.gain, options))
      continue;
    if (!best || here.comparison.gain > best->comparison.gain) best = std::move(here);
  }
  if (!best) return std::nullopt;
  const char which = best->side == Side::a ? 'a' : 'b';
  Finding finding;
  finding.code = std::string("axes_") + which;
  finding.certain = true;
  finding.improvement = std::exp(best->comparison.gain);
  finding.T_a_b = to_pose(best->explained.fit.T);
  say(finding,
      format("The positions of %s hold a lever arm (%.3g %.3g %.3g %s) that was turned by the inverse "
             "rotations: the squared residuals are %.3g times smaller without it.",
             mark(which), best->arm.x(), best->arm.y(), best->arm.z(),
             options.unit == LengthUnit::metres ? "m" : "units", finding.improvement),
      format("Move the positions of %s by p + R l, with R from the body to the world.", mark(which)));
  return finding;
}

}  // namespace egocal::detail
