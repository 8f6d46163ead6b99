// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/planes.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "diagnosis/explanations/turning/plane_turning.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

Finding plane_finding(char which, std::string claim, std::string cure, bool certain = true) {
  Finding finding;
  finding.code = std::string("plane_") + which;
  finding.certain = certain;
  say(finding, std::move(claim), std::move(cure));
  return finding;
}

/// Finding that the distance of a ground plane is wrong; empty where it may be right. The motions do not show
/// this distance.
std::optional<Finding> wrong_height(char which, double distance, bool metres, const PlaneTiltOptions& tilt) {
  if (distance > 0)
    return plane_finding(
        which,
        format("The ground plane of %s lies %.2f m above the sensor: the normal points down, or the distance "
               "has the wrong sign.",
               mark(which), distance),
        format("{solve}--plane-%c with the normal up and D = -%.4g (minus the mounting height)", which,
               distance));
  if (!metres || !(-distance > tilt.most_height)) return std::nullopt;
  // heights from 3 cm to the limit: in millimetres, or in centimetres
  const double unit = -distance > 10 * tilt.most_height ? 1000 : 100;
  return plane_finding(which,
                       format("The ground plane of %s lies %.4g m below the sensor: no vehicle is that high.",
                              mark(which), -distance),
                       format("{solve}--plane-%c with D in metres: %.4g, if it is in %s", which,
                              distance / unit, unit > 100 ? "millimetres" : "centimetres"));
}

/// How the turns of both sensors belong together.
struct Sense {
  bool exchanged = false;  ///< each turns about the normal of the other one
  bool opposite = false;   ///< when one turns left about its normal, the other turns right
};

Sense sense_of(const Motions& motions, const PlaneTurning& turning, const GroundPlane& a,
               const GroundPlane& b, double aligned) {
  const auto along = [aligned](const AxisBesideNormal& turns, const GroundPlane& plane) {
    return std::abs(turns.axis.dot(plane.normal)) > aligned;
  };
  double common = 0;  // sum of the products of the turns about both normals
  for (const Motion& motion : motions.all)
    common += motion.a.real.tail<3>().dot(a.normal) * motion.b.real.tail<3>().dot(b.normal);
  const bool a_fits = along(turning.a, a), b_fits = along(turning.b, b);
  return {!a_fits && !b_fits && along(turning.a, b) && along(turning.b, a), a_fits && b_fits && common < 0};
}

std::vector<Finding> exchanged_planes() {
  std::vector<Finding> findings;
  for (const char which : {'a', 'b'})
    findings.push_back(plane_finding(which, "The ground planes of {a} and {b} are exchanged.",
                                     "Exchange {solve}--plane-a and --plane-b"));
  return findings;
}

std::vector<Finding> opposite_planes() {
  std::vector<Finding> findings;
  for (const char which : {'a', 'b'})
    findings.push_back(plane_finding(
        which,
        "The normals of the two ground planes point in opposite directions: "
        "when {a} turns left about its normal, {b} turns right.",
        format("Turn the normal of {solve}--plane-%c round, if it points down.", which), false));
  return findings;
}

std::string normal_to_check(char which, const AxisBesideNormal& turns) {
  return format("Check the normal of {solve}--plane-%c: the turns say (%.4f, %.4f, %.4f)", which,
                turns.axis.x(), turns.axis.y(), turns.axis.z());
}

bool apart_by_more(const NormalsApart& apart, const PlaneTiltOptions& tilt) {
  return apart.alike > tilt.least_alike && apart.angle > tilt.apart + tilt.sigmas * apart.stddev;
}

/// A normal that is not what its own sensor turns about. Where both are off alike, the body may lean:
/// by some degrees, not beyond `aligned`.
std::vector<Finding> off_axis(const PlaneTurning& turning, double aligned, const PlaneTiltOptions& tilt) {
  std::vector<Finding> findings;
  for (const auto& [which, turns] : {std::pair{'a', turning.a}, std::pair{'b', turning.b}})
    if (turns.off > tilt.alone + tilt.sigmas * turns.stddev)
      findings.push_back(plane_finding(
          which,
          format("Sensor %s turns about %s, which is %.2f +- %.2f deg from the normal of its ground plane.",
                 mark(which), axis_in_words(turns.axis).c_str(), turns.off / radians_per_degree,
                 turns.stddev / radians_per_degree),
          normal_to_check(which, turns),
          apart_by_more(turning.apart, tilt) || std::cos(turns.off) < aligned));
  return findings;
}

/// Normals that the turns of both sensors do not bring together: one of them is wrong, or both.
/// one_axis: whether each sensor turns about one axis, which says which of them.
std::vector<Finding> normals_apart(const PlaneTurning& turning, bool one_axis, const PlaneTiltOptions& tilt) {
  if (!apart_by_more(turning.apart, tilt)) return {};
  const double blamed = tilt.blamed * turning.apart.angle, cleared = tilt.cleared * turning.apart.angle;
  const bool only_a = one_axis && turning.a.off > blamed && turning.b.off < cleared,
             only_b = one_axis && turning.b.off > blamed && turning.a.off < cleared;
  const std::string claim = format(
      "By the turns of both sensors, the normals of the ground planes of {a} and {b} are %.2f +- %.2f "
      "deg apart",
      turning.apart.angle / radians_per_degree, turning.apart.stddev / radians_per_degree);
  std::vector<Finding> findings;
  for (const auto& [which, turns, cleared_by_own] :
       {std::tuple{'a', turning.a, only_b}, std::tuple{'b', turning.b, only_a}})
    if (!one_axis)
      findings.push_back(
          plane_finding(which, claim + ".", format("Check the normal of {solve}--plane-%c", which), false));
    else if (!cleared_by_own)
      findings.push_back(
          plane_finding(which,
                        claim + format("; that of %s is %.1f deg from the axis that its sensor turns about.",
                                       mark(which), turns.off / radians_per_degree),
                        normal_to_check(which, turns), only_a || only_b));
  return findings;
}

}  // namespace

std::vector<Finding> check_planes(const Explained& given, const GroundPlane& a, const GroundPlane& b,
                                  bool metres, const PlaneCheckOptions& options,
                                  const PlaneTiltOptions& tilt) {
  std::vector<Finding> findings;
  for (const auto& [which, plane] : {std::pair{'a', a}, std::pair{'b', b}})
    if (std::optional<Finding> finding = wrong_height(which, plane.distance, metres, tilt))
      findings.push_back(*std::move(finding));
  const PlaneTurning turning = plane_turning(given, a.normal, b.normal, tilt.blocks);
  const auto add = [&findings](const std::vector<Finding>& more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  const bool one_axis = turning.a.ratio > options.one_axis && turning.b.ratio > options.one_axis;
  if (one_axis) {
    const Sense sense = sense_of(given.motions, turning, a, b, options.aligned);
    if (sense.exchanged) {
      add(exchanged_planes());
      return findings;
    }
    add(off_axis(turning, options.aligned, tilt));
    if (!findings.empty()) return findings;
    if (sense.opposite) return opposite_planes();
  }
  if (findings.empty()) add(normals_apart(turning, one_axis, tilt));
  return findings;
}

}  // namespace egocal::detail
