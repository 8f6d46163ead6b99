// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/online/nominal_part.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <iterator>
#include <vector>

#include "egocal/problem/cost.hpp"
#include "egocal/uncertainty/observability.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal {

namespace {

using Directions = Eigen::Matrix<double, 6, Eigen::Dynamic>;

bool knows_rotation(const Pose& nominal) {
  return nominal.rotation.coeffs().allFinite();
}

/// Indices of what is known of x y z and the rotation vector.
std::vector<Eigen::Index> known_rows(const Pose& part) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < 3; ++i)
    if (std::isfinite(part.translation[i])) rows.push_back(i);
  if (knows_rotation(part))
    for (Eigen::Index i = 3; i < 6; ++i) rows.push_back(i);
  return rows;
}

DualQuaternion seen_from(const DualQuaternion& T_a_b, NominalOf of) {
  return of == NominalOf::b_in_a ? T_a_b : conjugate(T_a_b);
}

/// The hidden directions in the frame of the nominal value, orthonormal; lengths in the basis' unit.
Directions hidden_from(const DirectionBasis& hidden, const DualQuaternion& T_a_b, NominalOf of) {
  constexpr double small = 1e-6;  // mathematics: a difference quotient, off by its square
  Directions directions(6, hidden.basis.cols());
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    detail::Vector6d step = small * hidden.basis.col(k);
    step.head<3>() *= hidden.length;
    directions.col(k) =
        detail::frame_a_difference(seen_from(T_a_b, of), seen_from(detail::frame_a_moved(T_a_b, step), of)) /
        small;
    directions.col(k).head<3>() /= hidden.length;
  }
  if (of == NominalOf::b_in_a || directions.cols() == 0) return directions;
  return Eigen::HouseholderQR<Directions>(directions).householderQ() *
         Directions::Identity(6, directions.cols());
}

}  // namespace

bool is_part(const Pose& nominal) {
  return !nominal.translation.allFinite() || !knows_rotation(nominal);
}

std::string known_in_words(const Pose& nominal) {
  std::string names;
  const auto add = [&names](const char* name) { names += (names.empty() ? "" : ", ") + std::string(name); };
  constexpr const char* axes[] = {"x", "y", "z"};
  for (Eigen::Index i = 0; i < 3; ++i)
    if (std::isfinite(nominal.translation[i])) add(axes[i]);
  if (knows_rotation(nominal)) add("rotation");
  return names;
}

std::string wrong_with_part(const Pose& nominal) {
  const auto q = nominal.rotation.coeffs().array();
  if (q.isFinite().any() && !q.isFinite().all()) return "give all of the quaternion, or nan for all of it";
  if (known_in_words(nominal).empty()) return "nothing of it is known";
  return {};
}

std::optional<DualQuaternion> completed_nominal(const Pose& part, const Problem& problem,
                                                const DualQuaternion& T_a_b, NominalOf of,
                                                const NominalPartOptions& options) {
  DirectionBasis hidden;  // in planar mode the planes give what the motions do not
  if (problem.mode != Mode::planar) hidden = hidden_directions(problem, cost_matrix(problem), T_a_b);
  const Directions directions = hidden_from(hidden, T_a_b, of);
  const DualQuaternion answer = seen_from(T_a_b, of);
  const std::vector<Eigen::Index> rows = known_rows(part);
  Pose result = to_pose(answer);
  if (directions.cols() > 0) {
    const bool turns = knows_rotation(part);
    detail::Vector6d wish = detail::frame_a_difference(
        result, to_dual_quaternion({turns ? part.rotation : result.rotation, result.translation}));
    wish.head<3>() = (part.translation - result.translation) / hidden.length;
    if (std::ssize(rows) < directions.cols()) return std::nullopt;
    const Eigen::JacobiSVD<Eigen::MatrixXd> seen(directions(rows, Eigen::all),
                                                 Eigen::ComputeThinU | Eigen::ComputeThinV);
    if (!(seen.singularValues().minCoeff() >= options.least_seen)) return std::nullopt;
    detail::Vector6d step = directions * seen.solve(Eigen::VectorXd(wish(rows)));
    step.head<3>() *= hidden.length;
    result = to_pose(detail::frame_a_moved(answer, step));
  }
  for (const Eigen::Index row : rows)
    if (row < 3) result.translation[row] = part.translation[row];
  if (knows_rotation(part)) result.rotation = part.rotation;
  return seen_from(to_dual_quaternion(result), of);
}

}  // namespace egocal
