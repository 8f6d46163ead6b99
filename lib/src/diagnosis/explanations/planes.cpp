// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/planes.hpp"

#include <cmath>

#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "linear_algebra/symmetric_eigen.hpp"

namespace egocal::detail {

namespace {

struct Turning {
  Eigen::Matrix3d squares_a = Eigen::Matrix3d::Zero(), squares_b = Eigen::Matrix3d::Zero();
  double common = 0;  ///< sum of the products of the turns about both normals
};

Eigen::Vector3d turn(const DualQuaternion& motion) {
  return 2 * motion.real.tail<3>();
}

/// Direction of the axis, if there is one.
bool axis_of(const Eigen::Matrix3d& squares, double one_axis, Eigen::Vector3d& axis) {
  const SymmetricEigen<3> eigen = symmetric_eigen<3>(squares);
  axis = eigen.vectors.col(2);
  return eigen.values[2] > one_axis * std::max(0.0, eigen.values[1]) && eigen.values[2] > 0;
}

Finding plane_finding(char which, std::string claim, std::string cure, bool certain = true) {
  Finding finding;
  finding.code = std::string("plane_") + which;
  finding.certain = certain;
  say(finding, std::move(claim), std::move(cure));
  return finding;
}

}  // namespace

std::vector<Finding> check_planes(const Motions& motions, const GroundPlane& a, const GroundPlane& b,
                                  const PlaneCheckOptions& options) {
  std::vector<Finding> findings;
  for (const auto& [which, plane] : {std::pair{'a', a}, std::pair{'b', b}})
    if (plane.distance > 0)
      findings.push_back(plane_finding(
          which,
          format(
              "The ground plane of %s lies %.2f m above the sensor: the normal points down, or the distance "
              "has the wrong sign.",
              mark(which), plane.distance),
          format("{solve}--plane-%c with the normal up and D = -%.4g (minus the mounting height)", which,
                 plane.distance)));

  Turning turning;
  for (const Motion& motion : motions.all) {
    const Eigen::Vector3d turn_a = turn(motion.a), turn_b = turn(motion.b);
    turning.squares_a += turn_a * turn_a.transpose();
    turning.squares_b += turn_b * turn_b.transpose();
    turning.common += turn_a.dot(a.normal) * turn_b.dot(b.normal);
  }
  Eigen::Vector3d axis_a, axis_b;
  if (!axis_of(turning.squares_a, options.one_axis, axis_a) ||
      !axis_of(turning.squares_b, options.one_axis, axis_b))
    return findings;
  const bool a_fits = std::abs(axis_a.dot(a.normal)) > options.aligned,
             b_fits = std::abs(axis_b.dot(b.normal)) > options.aligned;
  if (!a_fits && !b_fits && std::abs(axis_a.dot(b.normal)) > options.aligned &&
      std::abs(axis_b.dot(a.normal)) > options.aligned) {
    for (const char which : {'a', 'b'})
      findings.push_back(plane_finding(which, "The ground planes of {a} and {b} are exchanged.",
                                       "Exchange {solve}--plane-a and --plane-b"));
  } else {
    for (const auto& [which, fits, axis] : {std::tuple{'a', a_fits, axis_a}, std::tuple{'b', b_fits, axis_b}})
      if (!fits)
        findings.push_back(plane_finding(
            which,
            format("Sensor %s turns about (%.2f, %.2f, %.2f), which is not the normal of its ground plane.",
                   mark(which), axis.x(), axis.y(), axis.z()),
            format("Check the normal of {solve}--plane-%c", which)));
  }
  // both turn left at the same time: one normal is upside down otherwise
  if (a_fits && b_fits && turning.common < 0 && findings.empty())
    for (const char which : {'a', 'b'})
      findings.push_back(plane_finding(
          which,
          "The normals of the two ground planes point in opposite directions: "
          "when {a} turns left about its normal, {b} turns right.",
          format("Turn the normal of {solve}--plane-%c round, if it points down.", which), false));
  return findings;
}

}  // namespace egocal::detail
